#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "backends/interface/backend.h"
#include "model/energy.h"
#include "model/system.h"

namespace mssim {

/// How long to simulate and how often to look.
struct SimulationPlan {
  double dt_s = 0;
  double duration_s = 0;
  double frames_per_second = 0;  ///< of simulated time
  /// Whether to account for energy losses (EnergyLedger), which makes a run several times slower.
  bool accounts_for_losses = false;
};

/// A moment of a simulation.
struct Frame {
  std::int64_t step = 0;  ///< counted from 0, the start
  double time_s = 0;
  const State& state;
  Energy energy;
  std::optional<EnergyLosses> losses;  ///< since the start, where the plan asks for them
};

/// What a simulation tells and asks while it runs.
struct SimulationWatch {
  /// Called with the start and then with every frame.
  std::function<void(const Frame& frame)> on_frame;
  /// Called between steps, with how many of how many are done; what it throws ends the simulation.
  std::function<void(std::int64_t done, std::int64_t steps)> on_progress = [](std::int64_t /*done*/,
                                                                              std::int64_t /*steps*/) {};
};

/// Steps `backend`, which was made for `system` and `integrator`, from the system's start through the whole
/// duration, which is rounded to whole steps; a frame is the step nearest to its time. Throws NotVerified
/// when the simulation blows up, naming step, time and node; frames up to then have been delivered. Throws
/// UsageError for a plan of no steps or of more than one frame a step.
void simulate(Backend& backend, const System& system, const Integrator& integrator,
              const SimulationPlan& plan, const SimulationWatch& watch);

/// Steps of a plan. Throws UsageError like simulate().
std::int64_t count_steps(const SimulationPlan& plan);

/// The frames of steps of `dt_s`. Throws UsageError for more than one frame a step.
FrameGrid frame_grid(double frames_per_second, double dt_s);

}  // namespace mssim
