#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "application/choices.h"
#include "application/outputs.h"
#include "application/prepared_scene.h"
#include "backends/interface/backend.h"
#include "bench/verification/verification.h"
#include "model/system.h"
#include "output/pictures/painter.h"

namespace mssim {

/// Duration and step of a simulation, and the rate of its frames.
struct SimulationPlan {
  double dt_s = 0;
  double duration_s = 0;
  double frames_per_second = 0;  ///< of simulated time
  /// Whether to account for energy losses (EnergyLedger), which slows a run down several times.
  bool accounts_for_losses = false;
  std::string_view remedy = shorter_scene_step;  ///< if the simulation blows up
};

/// The state of a simulation at one time.
struct Frame {
  std::int64_t step = 0;  ///< counted from 0, the start
  double time_s = 0;
  const State& state;
  Energy energy;
  std::optional<EnergyLosses> losses;  ///< since the start, if the plan requests them
};

/// Steps between two looks at signals, within a frame too.
inline constexpr int most_steps_at_once = 240;

/// Callbacks of a simulation.
struct SimulationWatch {
  /// Called with the start and then with every frame.
  std::function<void(const Frame& frame)> on_frame;
  /// Called at least before every most_steps_at_once steps, with the finished and the total number; an
  /// exception ends the simulation.
  std::function<void(std::int64_t done, std::int64_t steps)> on_progress = [](std::int64_t /*done*/,
                                                                              std::int64_t /*steps*/) {};
};

/// Steps `backend`, which must be made for `system` and `integrator`, from the system's start for the
/// duration, rounded to whole steps. Frames are at the steps nearest to their times. Throws NotVerified with
/// step, time and node if the simulation blows up; earlier frames have been delivered. Throws UsageError for
/// a plan of no steps or of more than one frame per step.
void simulate(Backend& backend, const System& system, const Integrator& integrator,
              const SimulationPlan& plan, const SimulationWatch& watch);

/// Files that a run writes from its frames; an empty name means none.
struct RunFiles {
  std::string trace;
  std::string energy_curve;
  std::string pictures;    ///< a folder
  bool temporary = false;  ///< not reported to the user
  /// What the caller writes after the run, which is refused if this is one of its files or cannot be written.
  std::optional<NamedFile> later;

  bool any() const { return !trace.empty() || !energy_curve.empty() || !pictures.empty(); }
};

/// Default simulated time, s.
inline constexpr double default_duration_s = 1;

/// Options of a run: scene, backend, duration and files.
struct RunOptions {
  std::string scene;
  std::string backend = "openmp";
  OwnBackendOptions own_backends;
  std::string integrator = "semi-euler";
  std::string precision;  ///< "single" or "double"; empty: that of the backend's row
  std::optional<double> dt_s;
  std::optional<double> duration_s;  ///< default_duration_s if not given
  std::optional<double> fps;         ///< frames per simulated second
  double usual_fps = 60;             ///< if fps is not given; one per step if steps are longer
  RunFiles files;
  PictureOptions pictures;  ///< of files.pictures, except for the threads
  bool losses = false;
  bool silent = false;  ///< prints no result tables
  ExecutionOptions execution;
};

/// Simulates the scene (a garment until it has settled), writes the files and prints the results. Returns an
/// ExitCode. Throws UsageError, SceneError, Unsupported, Unavailable, MissingProgram, WriteError,
/// Interrupted, and NotVerified if the simulation blows up.
int run_scene(RunOptions options);

}  // namespace mssim
