#pragma once

#include <optional>
#include <string>

#include "backends/interface/backend.h"
#include "commands/arguments/arguments.h"
#include "commands/run/run_recorder.h"
#include "commands/shared/backend_choice.h"
#include "commands/shared/picture_choice.h"

namespace mssim {

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
  PictureChoice look;  ///< of files.pictures
  bool losses = false;
  bool silent = false;  ///< prints no tables of how it went
  ExecutionOptions execution;
};

/// Declares --backend, --integrator, --duration, --fps, --dt and those of declare_execution. `options` must
/// outlive the parsing. Where `needed` is given, those that only a simulation takes are errors without it.
void declare_stepping(Arguments& arguments, RunOptions& options, const std::string& about_fps,
                      std::optional<Argument> needed = {});

/// Simulates the scene, dresses its garment until it has settled, writes the files and prints how it went.
/// Returns an ExitCode. Throws UsageError, SceneError, Unsupported, Unavailable, MissingProgram, NotVerified
/// where the simulation blows up, WriteError and Interrupted.
int run_scene(RunOptions options);

}  // namespace mssim
