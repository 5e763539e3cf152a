#pragma once

#include "backends/interface/backend.h"

namespace mssim {

/// How long steps take.
struct StepTime {
  double seconds = 0;  ///< a step, in the fastest of the runs: other programs only ever add to one
  int runs = 0;
};

/// Times runs of `steps` steps from the system's start, after one of at most ten that is not counted, until
/// they have taken `enough_s` and are five, or have taken ten times that; one at least. Where the first run
/// alone takes that long with all the steps, it is the only one. Only step() is timed.
StepTime time_steps(Backend& backend, const System& system, int steps, double enough_s);

}  // namespace mssim
