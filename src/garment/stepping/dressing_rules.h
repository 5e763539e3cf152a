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

// The rules of a dressing in the precision of its backends: Real is float or double.

/// Throws Unsupported for an integrator other than semi-euler.
void require_semi_euler(const Integrator& integrator);

/// Damping, gravity and friction of a phase: while the seams close, or after.
template <class Real>
struct PhaseRule {
  Real damping;  ///< 1/s, per mass
  Real gravity;  ///< m/s^2, downwards
  Real friction;
};

/// While draping, damping and gravity of the scene, and the friction of `rules`; while the seams close, those
/// of `rules` for seaming, without friction.
template <class Real>
PhaseRule<Real> phase_rule(const System& system, const DressingSettings& rules, bool draping) {
  if (draping)
    return {static_cast<Real>(system.viscous_damping), static_cast<Real>(system.gravity),
            static_cast<Real>(rules.friction)};
  return {static_cast<Real>(rules.seaming_damping), static_cast<Real>(rules.seaming_gravity * system.gravity),
          0};
}

/// The correction of over-elongated springs (kernels/garment_laws.h).
template <class Real>
struct CorrectionRule {
  Real limit;       ///< largest length over rest length that is not corrected
  Real rate_per_s;  ///< see elongation_impulse
};

/// The rule for steps of dt_s (s); rate 0 without the bounded correction.
template <class Real>
CorrectionRule<Real> correction_rule(const DressingSettings& rules, double dt_s) {
  const bool bounded = rules.correction == VelocityCorrection::bounded;
  return {1 + static_cast<Real>(rules.correction_threshold),
          bounded ? static_cast<Real>(rules.correction_rate) / static_cast<Real>(dt_s) : Real{0}};
}

/// Sweeps over all springs per step.
inline std::uint32_t correction_sweeps(const DressingSettings& rules) {
  return rules.correction == VelocityCorrection::none ? 0 : rules.correction_sweeps;
}

/// The arguments of closing_rate (kernels/garment_laws.h), by which a sewn joint closes its gap.
template <class Real>
struct ClosingRule {
  Real most;   ///< 1/s
  Real speed;  ///< m/s
};

/// The rule for steps of dt_s (s).
template <class Real>
ClosingRule<Real> closing_rule(const DressingSettings& rules, double dt_s) {
  return {static_cast<Real>(rules.closing_share / dt_s), static_cast<Real>(rules.closing_speed)};
}

/// Progress before the first step of a dressing that starts from this state.
inline DressingProgress first_progress(const Garment& garment, const State& start) {
  return {start.draped ? 0 : garment.joints.size(), start.draped || garment.joints.empty(), 0};
}

/// Whether seaming ends after `steps` steps.
inline bool ends_seaming(const DressingSettings& rules, const DressingProgress& progress, std::int64_t steps,
                         double dt_s) {
  return !progress.draping &&
         (progress.open_joints == 0 || static_cast<double>(steps) * dt_s >= rules.longest_seaming_s);
}

/// The joints that are sewn, and the progress of the dressing.
struct Seaming {
  std::vector<std::uint8_t> sewn;  ///< [joints]
  DressingProgress progress;
  std::int64_t steps = 0;

  /// Before the first step from this state.
  void start(const Garment& garment, const State& start);
  /// Counts a step and the joints that are still open. Sews those at the end of seaming.
  void end_step(const DressingSettings& rules, double dt_s);
};

// The laws of kernels/garment_laws.h for one joint.

/// A number or vector T for each of the three nodes of a joint.
template <class T>
struct AtJoint {
  T node, first, second;
};

/// The vector from the node to the point `fraction` of the way from first to second: a gap (m), or its rate.
template <class Real>
Vec3<Real> joint_gap(const AtJoint<Vec3<Real>>& at, Real fraction) {
  return joint_gap(at.node, at.first, at.second, fraction);
}

/// Changes of the three velocities by an impulse on the node and its opposite on the point.
template <class Real>
AtJoint<Vec3<Real>> spread(const JointEnds<Real>& ends, const Vec3<Real>& impulse) {
  return {ends.node * impulse, ends.first * impulse, ends.second * impulse};
}

/// Accelerations of the three nodes (m/s^2) by which loop 3 draws a joint together, from their positions (m)
/// and inverse masses (1/kg); none if the gap is small enough to sew it. time_s: since the first step.
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

/// Changes of the three velocities (m/s) after which the gap of a sewn joint only closes.
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

/// With fewer nodes, one thread searches for layers that touch: OpenMP's threads may take longer to
/// synchronise if other programs run (backends/threads/spin_wait.h).
inline constexpr std::size_t least_shared_nodes = 16'384;

/// Makes the collision of a garment's layers, which runs after loop 4 has updated velocities and before
/// contact with the body, on one thread or on `threads`. None if the layers do not touch.
std::optional<ClothClothCollision> layer_collision(const System& system, const Garment& garment, int threads);

}  // namespace mssim
