#include "commands/bench/verified_rows.h"

#include <algorithm>

#include "bench/results/comparison.h"
#include "commands/bench/measured_run.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Why what was verified then need not be right now.
std::vector<std::string> doubts(const Provenance& then, const Provenance& now) {
  std::vector<std::string> all = differences(then, now);
  if (!then.program_fnv1a_64 || then.program_fnv1a_64 != now.program_fnv1a_64)
    all.emplace_back("it was written by another program");
  if (then.device_memory != now.device_memory)
    all.push_back("--memory was " + then.device_memory + " and is " + now.device_memory);
  // None are named by a bench whose backends need none.
  if (!now.opencl_devices.empty() && then.opencl_devices != now.opencl_devices)
    all.emplace_back("the OpenCL devices are not the same");
  for (const BackendProgramRecord& program : now.backend_programs)
    if (std::ranges::find(then.backend_programs, program) == then.backend_programs.end())
      all.push_back("the program " + program.name + " is not the same");
  if (then.tetgen != now.tetgen) all.emplace_back("TetGen is not the same");
  for (const SceneHash& scene : now.scenes)
    if (std::ranges::find(then.scenes, scene.name, &SceneHash::name) == then.scenes.end())
      all.push_back("it has no scene " + scene.name);
  return all;
}

void require_row(const std::vector<ResultRow>& rows, const std::string& scene, const BackendInfo& backend,
                 const Integrator& integrator, const std::string& folder) {
  const bool found = std::ranges::any_of(rows, [&](const ResultRow& row) {
    return row.scene == scene && row.backend == backend.name && row.integrator == integrator.name;
  });
  if (!found)
    throw UsageError("--verified " + folder + " has no row of " + scene + ", " + std::string(backend.name) +
                     ", " + std::string(integrator.name) + ": ask for what it has, or leave --verified out");
}

}  // namespace

std::vector<ResultRow> verified_rows(const std::string& folder, const Provenance& now,
                                     const BenchSettings& settings, const std::vector<SceneSpec>& scenes) {
  MeasuredRun earlier = read_run(folder);
  if (const std::vector<std::string> all = doubts(earlier.provenance, now); !all.empty())
    throw UsageError("--verified cannot rely on " + folder + ": " + join(all, "; ") +
                     "; leave it out to verify anew");
  for (const SceneSpec& scene : scenes)
    for (const Integrator* integrator : settings.integrators)
      for (const BackendInfo* backend : settings.backends)
        require_row(earlier.rows, scene.name, *backend, *integrator, folder);
  return std::move(earlier.rows);
}

}  // namespace mssim
