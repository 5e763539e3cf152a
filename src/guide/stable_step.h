#pragma once

#include <functional>
#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// A backend of one integrator with this step, at the system's start.
using StepMaker = std::function<std::unique_ptr<Backend>(double dt_s)>;

/// Where the largest stable step is looked for, and by which runs.
struct StepSearch {
  double first_s = 0;                                  ///< step that is tried first
  double longest_s = 0;                                ///< no longer one is tried
  double shortest_s = 0;                               ///< no shorter one is tried
  double span_s = 0;                                   ///< simulated time of a run
  int least_steps = 50;                                ///< of a run: it goes on beyond the span for them
  std::function<bool()> stop = [] { return false; };   ///< ends the search between two runs
  std::function<bool()> hurry = [] { return false; };  ///< ends it as soon as it knows both kinds of step
};

/// Between which steps the limit lies.
struct StableStep {
  double stable_s = 0;    ///< the longest step that was stable; 0: none that was tried
  double unstable_s = 0;  ///< the shortest longer one that was not; 0: none that was tried
  int runs = 0;
  double span_s = 0;     ///< simulated time of a run, at least
  bool finished = true;  ///< else stop() or hurry() ended the search before the two were near each other
};

/// Whether a run of the search with this step stays below energy_bound. `backend` has that step.
bool is_stable(Backend& backend, const System& system, double dt_s, const StepSearch& search);

/// Two steps this near to each other (as a ratio) end the search.
inline constexpr double step_resolution = 1.02;

/// The largest step with which real runs stay below energy_bound: from `first_s` up or down by half as much
/// again, and by ever larger strides, until one step is stable and a longer one is not; then by bisection of
/// their ratio. What grows so slowly that a run does not show it counts as stable.
StableStep largest_stable_step(const System& system, const StepMaker& make, const StepSearch& search);

}  // namespace mssim
