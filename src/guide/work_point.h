#pragma once

#include <optional>
#include <string>

#include "integrators/integrator.h"

namespace mssim {

/// What a step of one size costs and how far off it ends: a point of a work-precision curve (Hairer, Norsett
/// and Wanner, Solving Ordinary Differential Equations I, section II.10).
struct WorkPoint {
  const Integrator* integrator = nullptr;
  std::string backend;
  int steps = 0;              ///< over the horizon
  double dt_s = 0;            ///< of simulated time
  double seconds_a_step = 0;  ///< of wall time, in the fastest of `samples` runs over the horizon
  int samples = 0;
  /// Force evaluations a step: the stages of an explicit method, the iterations of fast-springs, the small
  /// steps of xpbd. None of methods with conjugate gradients, whose number differs from step to step.
  std::optional<double> evaluations;
  bool diverged = false;  ///< not finite, or with more energy than energy_bound allows
  /// The step is no longer than the largest that was stable in runs, which may be longer than the horizon:
  /// what does not diverge within that may do so when it meets the floor.
  bool within_limit = true;
  /// Largest distance from the trusted state at the horizon, in mean rest lengths; none where not finite.
  std::optional<double> position_error;
  std::optional<double> energy_error;  ///< of the total energy, over the trusted kinetic + elastic energy
  /// Of implicit methods, where there was time: the distance from exact backward Euler with the same step,
  /// which is the solver's error, and that one's from the trusted state, which is the step's. In mean rest
  /// lengths.
  std::optional<double> solver_error, step_error;
  bool beyond_trust = false;  ///< the error is not trusted_margin times the trusted state's own
  bool on_front = false;      ///< no other point is both as fast and as accurate (pareto_front.h)
  std::string note;           ///< the backend's

  /// Wall time of a simulated second, s: what a user waits for.
  double seconds_a_second() const { return seconds_a_step / dt_s; }
  /// Whether conclusions may rest on it.
  bool counts() const { return !diverged && within_limit && !beyond_trust && position_error.has_value(); }
};

/// Of the same method?
inline bool same_method(const WorkPoint& a, const WorkPoint& b) {
  return a.integrator == b.integrator && a.backend == b.backend;
}

}  // namespace mssim
