#pragma once

#include <cstdint>

#include "garment/stepping/dressing_backend.h"
#include "model/system.h"

namespace mssim {

/// The rules of a dressing as its backends compute with them: Real is float or double.

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

/// Which springs are corrected, and how (kernels/elongation_law.h).
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

/// How a sewn joint closes its gap: the arguments of closing_rate (kernels/joint_law.h).
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

}  // namespace mssim
