#pragma once

#include <cmath>
#include <optional>

#include "garment/garment.h"
#include "garment/stepping/dressing_rules.h"
#include "laws/host_laws.h"

namespace mssim {

/// kernels/joint_law.h for a joint at a time on the host: Real is float or double.

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

}  // namespace mssim
