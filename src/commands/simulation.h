#pragma once

#include <cstdint>
#include <functional>

#include "backends/backend.h"
#include "model/energy.h"

namespace mssim {

/// How long to simulate and how often to look.
struct SimulationPlan {
  double dt_s = 0;
  double duration_s = 0;
  double frames_per_second = 0;  ///< of simulated time
};

/// Called with the start and then with every frame; `step` counts from 0.
using OnFrame =
    std::function<void(std::int64_t step, double time_s, const State& state, const Energy& energy)>;

/// Steps `backend` from the system's start through the whole duration, which is rounded to whole steps; a
/// frame is the step nearest to its time. Throws NotVerified when the simulation blows up, naming step, time
/// and node; frames up to then have been delivered. Throws UsageError for a plan of no steps or of more than
/// one frame a step.
void simulate(Backend& backend, const System& system, const SimulationPlan& plan, const OnFrame& on_frame);

}  // namespace mssim
