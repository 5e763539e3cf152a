#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "application/choices.h"
#include "application/console.h"
#include "application/prepared_scene.h"
#include "backends/interface/backend.h"
#include "model/system.h"
#include "output/pictures/painter.h"
#include "output/traces/energy_curve.h"
#include "output/traces/h5md_trace.h"

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

/// What a run writes from its frames, each only where it has a name.
struct RunFiles {
  std::string trace;
  std::string energy_curve;
  std::string pictures;    ///< a folder
  bool temporary = false;  ///< nobody is told of them

  bool any() const { return !trace.empty() || !energy_curve.empty() || !pictures.empty(); }
};

/// What the files say about how they came about, beside what the scene says, and how pictures look.
struct FileHeaders {
  TraceHeader trace;
  std::string command_line;  ///< of the energy curve
  PictureOptions pictures;
};

/// Throws UsageError when two of the files, the XDMF of the trace, and the files that the scene is read from,
/// are the same.
void require_distinct(const RunFiles& files, const SceneSpec& scene);

/// Writes the frames of a run into its files, each while the simulation goes on to the next one, because
/// compressing a large frame takes as long as many steps; and keeps their energies.
class RunRecorder {
 public:
  /// Begins the files of a scene that there are to be. Throws WriteError, also where another writer has one.
  RunRecorder(const RunFiles& files, const PreparedScene& scene, const FileHeaders& headers);

  /// Whether anything is written.
  bool wanted() const { return trace_ || curve_ || pictures_; }
  /// Throws WriteError where the frame before cannot be written.
  void record(const Frame& frame);
  const std::vector<EnergySample>& energies() const { return energies_; }

  /// Runs `simulation`, which records, and finishes the files: also when it blows up or is interrupted,
  /// because the frames before that are good and show what happened. Says on stderr what has been written.
  /// Where a file cannot be written any more, files stay under their temporary names with all frames that
  /// were recorded before, and the WriteError says so. Passes on what `simulation` throws.
  void finish_after(const std::function<void()>& simulation);

 private:
  void write(const Frame& frame);
  /// Waits until the last frame is written. Throws WriteError where it cannot be.
  void wait_for_frame();
  void finish();
  /// What the files hold that did not get their names, for the end of a message.
  std::string kept();

  bool temporary_;
  std::optional<H5mdTrace> trace_;
  std::optional<EnergyCurve> curve_;
  std::optional<PictureFolder> pictures_;
  std::vector<EnergySample> energies_;
  std::future<void> writing_;  ///< of a frame into the files; nobody else touches them meanwhile
};

/// Simulated seconds of a run that says nothing of them.
inline constexpr double default_duration_s = 1;

/// What to simulate, by what, how long, and what to write.
struct RunOptions {
  std::string scene;
  std::string backend = "openmp";
  OwnBackendOptions own_backends;
  std::string integrator = "semi-euler";
  std::string precision = "single";
  std::optional<double> dt_s;
  std::optional<double> duration_s;  ///< default_duration_s where it is not given
  std::optional<double> fps;         ///< frames per simulated second, 60 where it is not given
  RunFiles files;
  PictureOptions pictures;  ///< of files.pictures, but for the threads
  bool losses = false;
  bool silent = false;  ///< prints no tables of how it went
  ExecutionOptions execution;
};

/// Simulates the scene, dresses its garment until it has settled, writes the files and prints how it went.
/// Returns an ExitCode. Throws UsageError, SceneError, Unsupported, Unavailable, MissingProgram, NotVerified
/// where the simulation blows up, WriteError and Interrupted.
int run_scene(RunOptions options);

}  // namespace mssim
