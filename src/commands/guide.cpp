#include <memory>

#include "application/guide_run.h"
#include "commands/command.h"
#include "commands/options.h"

namespace mssim {

std::function<int()> declare_guide(Arguments& arguments) {
  const auto options = std::make_shared<GuideOptions>();
  add_scenes(arguments, "--scene", options->scenes,
             "Scenes to measure: names (see mssim list scenes) or files")
      .required();
  arguments.add_number("--fps N", options->wish.frames_per_second,
                       "Target frame rate, in frames per second (default: 60)", number_between(1, 10'000));
  arguments.add_number("--error E", options->wish.error,
                       "Maximum position error, in mean rest lengths (default: 1e-3)", positive_number());
  arguments.add_number("--horizon SECONDS", options->horizon_s,
                       "Simulated time after which errors are measured, at most (default: 0.1)",
                       number_between(1e-6, 10));
  declare_backends_and_integrators(
      arguments, *options,
      "Backends, which may be programs of your own (default: serial, openmp and opencl; see mssim list "
      "backends)",
      "Integrators (default: all; see mssim list integrators)");
  declare_execution(arguments, options->execution);
  arguments.add_number(
      "--time-budget SECONDS", options->time_budget_s,
      "Time for all scenes, about; too little for a recommendation: exit code 1 (default: 90 for each)",
      time_budget());
  arguments.add("--out FOLDER", options->folder,
                "Folder for the results: guide.md, tables as CSV, provenance");
  arguments.add_flag("--overwrite", options->overwrite, "Replace the results that the folder has");
  return [options] { return run_guide(*options); };
}

}  // namespace mssim
