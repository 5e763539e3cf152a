#pragma once

#include <optional>
#include <string>

#include "backends/interface/backend.h"
#include "commands/arguments/arguments.h"
#include "commands/run/run_recorder.h"

namespace mssim {

/// What to simulate, by what, how long, and what to write.
struct RunOptions {
  std::string scene;
  std::string backend = "openmp";
  std::string integrator = "semi-euler";
  std::string precision = "single";
  std::optional<double> dt_s;
  std::optional<double> duration_s;  ///< default_duration_s where it is not given
  double fps = 60;
  RunFiles files;
  bool losses = false;
  ExecutionOptions execution;
};

/// Declares --backend, --integrator, --duration, --fps, --dt and those of declare_execution. `options` must
/// outlive the parsing.
void declare_stepping(Arguments& arguments, RunOptions& options, const std::string& about_fps);

/// Simulates the scene, dresses its garment until it has settled, writes the files and prints how it went.
/// Returns an ExitCode. Throws UsageError, SceneError, Unsupported, Unavailable, MissingProgram, NotVerified
/// where the simulation blows up, WriteError and Interrupted.
int run_scene(const RunOptions& options);

}  // namespace mssim
