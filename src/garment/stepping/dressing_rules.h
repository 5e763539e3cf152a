#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "garment/layers/cloth_cloth.h"
#include "garment/stepping/dressing_backend.h"
#include "laws/host_laws.h"
#include "model/system.h"

namespace mssim {

// The rules of a dressing as its backends compute with them: Real is float or double.

/// Throws Unsupported for another integrator than semi-euler.
void require_semi_euler(const Integrator& integrator);

/// What acts on the nodes beside springs, joints and the body. It changes when the seams are closed.
template <class Real>
struct PhaseRule {
  Real damping;  ///< 1/s, per mass
  Real gravity;  ///< m/s^2, downwards
  Real friction;
};

template <class Real>
PhaseRule<Real> phase_rule(const System& system, const DressingSettings& rules, bool draping) {
  if (draping)
    return {static_cast<Real>(system.viscous_damping), static_cast<Real>(system.gravity),
            static_cast<Real>(rules.friction)};
  return {static_cast<Real>(rules.seaming_damping), static_cast<Real>(rules.seaming_gravity * system.gravity),
          0};
}

/// Which springs are corrected, and how (kernels/garment_laws.h).
template <class Real>
struct CorrectionRule {
  Real limit;       ///< length over rest length
  Real rate_per_s;  ///< see elongation_impulse
};

template <class Real>
CorrectionRule<Real> correction_rule(const DressingSettings& rules, double dt_s) {
  const bool bounded = rules.correction == VelocityCorrection::bounded;
  return {1 + static_cast<Real>(rules.correction_threshold),
          bounded ? static_cast<Real>(rules.correction_rate) / static_cast<Real>(dt_s) : Real{0}};
}

/// Sweeps over all springs in a step.
inline std::uint32_t correction_sweeps(const DressingSettings& rules) {
  return rules.correction == VelocityCorrection::none ? 0 : rules.correction_sweeps;
}

/// How a sewn joint closes its gap: the arguments of closing_rate (kernels/garment_laws.h).
template <class Real>
struct ClosingRule {
  Real most;   ///< 1/s
  Real speed;  ///< m/s
};

template <class Real>
ClosingRule<Real> closing_rule(const DressingSettings& rules, double dt_s) {
  return {static_cast<Real>(rules.closing_share / dt_s), static_cast<Real>(rules.closing_speed)};
}

/// How a dressing that starts from this state stands before its first step.
inline DressingProgress first_progress(const Garment& garment, const State& start) {
  return {start.draped ? 0 : garment.joints.size(), start.draped || garment.joints.empty(), 0};
}

/// Whether the step after which `steps` have been taken is the last one of seaming.
inline bool ends_seaming(const DressingSettings& rules, const DressingProgress& progress, std::int64_t steps,
                         double dt_s) {
  return !progress.draping &&
         (progress.open_joints == 0 || static_cast<double>(steps) * dt_s >= rules.longest_seaming_s);
}

// kernels/garment_laws.h for a joint at a time.

/// Something that each of the three nodes of a joint has, T a number or a vector.
template <class T>
struct AtJoint {
  T node, first, second;
};

template <class Real>
Vec3<Real> joint_gap(const AtJoint<Vec3<Real>>& at, Real fraction) {
  return joint_gap(at.node, at.first, at.second, fraction);
}

/// What an impulse on the node, and its opposite on the point, gives the three.
template <class Real>
AtJoint<Vec3<Real>> spread(const JointEnds<Real>& ends, const Vec3<Real>& impulse) {
  return {ends.node * impulse, ends.first * impulse, ends.second * impulse};
}

/// Accelerations of the three (m/s^2) by which loop 3 draws a joint together, from their positions (m) and
/// inverse masses (1/kg); none where it is near enough to be sewn. time_s: since the first step.
template <class Real>
std::optional<AtJoint<Vec3<Real>>> pull_of_joint(const DressingSettings& rules, const Joint& joint,
                                                 double time_s, const AtJoint<Vec3<Real>>& x,
                                                 const AtJoint<Real>& inverse_mass) {
  const auto fraction = static_cast<Real>(joint.edge_share);
  const Vec3<Real> gap = joint_gap(x, fraction);
  const Real distance = std::sqrt(dot(gap, gap));
  if (distance < static_cast<Real>(rules.sewn_gap)) return std::nullopt;
  const double force =
      seam_force(rules.seam_force, time_s / rules.seam_force_doubling_s, joint.length, joint.strength);
  return spread(joint_ends(fraction, inverse_mass.node, inverse_mass.first, inverse_mass.second),
                static_cast<Real>(force) / distance * gap);
}

/// Changes of the velocities of the three (m/s) after which a sewn joint's gap closes and does nothing else.
template <class Real>
AtJoint<Vec3<Real>> closing_of_joint(const ClosingRule<Real>& rule, Real fraction,
                                     const AtJoint<Vec3<Real>>& x, const AtJoint<Vec3<Real>>& v,
                                     const AtJoint<Real>& inverse_mass) {
  const JointEnds<Real> ends =
      joint_ends(fraction, inverse_mass.node, inverse_mass.first, inverse_mass.second);
  const Real mobility = joint_mobility(ends, fraction);
  if (mobility == 0) return {};
  const Vec3<Real> gap = joint_gap(x, fraction), gap_rate = joint_gap(v, fraction);
  const Real rate = closing_rate(std::sqrt(dot(gap, gap)), rule.most, rule.speed);
  return spread(ends, {closing_impulse(gap.x, gap_rate.x, rate, mobility),
                       closing_impulse(gap.y, gap_rate.y, rate, mobility),
                       closing_impulse(gap.z, gap_rate.z, rate, mobility)});
}

/// Fewer nodes are searched for layers that touch by one thread: that takes less than OpenMP's threads may
/// take to meet where other programs run, too (backends/threads/spin_wait.h).
inline constexpr std::size_t least_shared_nodes = 16'384;

/// What the layers of a garment do to each other in a step, after loop 4 has updated velocities and before
/// the body is met, by one thread or as many as are given. None for a garment whose layers do not touch.
std::optional<ClothClothCollision> layer_collision(const System& system, const Garment& garment, int threads);

}  // namespace mssim
