#include "commands/bench/bench_plan.h"

#include <algorithm>

#include "commands/shared/choices.h"
#include "commands/shared/exit_code.h"
#include "integrators/integrators.h"

namespace mssim {
namespace {

std::vector<std::string> timed_scenes_of(const BenchOptions& options) {
  std::vector<std::string> scenes = scenes_of_suite(options.suite, true);
  for (const std::string& scene : options.scenes)
    if (std::ranges::find(scenes, scene) == scenes.end()) scenes.push_back(scene);
  return scenes;
}

/// All that there are, or those asked for in the table's order.
std::vector<const BackendInfo*> backends_of(const BenchOptions& options,
                                            const std::vector<const BackendInfo*>& known) {
  std::vector<const BackendInfo*> asked, all;
  for (const std::string& name : options.backends) asked.push_back(&require_backend(name, known));
  for (const BackendInfo* backend : known)
    if (asked.empty() || std::ranges::find(asked, backend) != asked.end()) all.push_back(backend);
  return all;
}

std::vector<const Integrator*> integrators_of(const BenchOptions& options,
                                              std::span<const std::string_view> by_default) {
  const bool every = options.integrators == std::vector<std::string>{"all"};
  std::vector<const Integrator*> asked, all;
  if (options.integrators.empty())
    for (const std::string_view name : by_default) asked.push_back(&require_integrator(std::string(name)));
  else if (!every)
    for (const std::string& name : options.integrators) asked.push_back(&require_integrator(name));
  for (const Integrator& integrator : integrators)
    if (every || std::ranges::find(asked, &integrator) != asked.end()) all.push_back(&integrator);
  return all;
}

}  // namespace

BenchPlan plan_of(const BenchOptions& options) {
  const Comparison& comparison = comparison_of_suite(options.suite);
  BenchPlan plan;
  plan.job.backends = backends_of(options, comparison.backends());
  plan.job.integrators = integrators_of(options, comparison.integrators);
  plan.job.execution = complete(options.execution);
  plan.job.rounds = options.rounds.value_or(options.time_budget_s ? most_rounds : usual_rounds);
  plan.timed = timed_scenes_of(options);
  plan.described = scenes_of_suite(options.suite, false);
  if (plan.timed.empty() && plan.described.empty())
    throw UsageError("there is nothing to measure: name a --scene or a --suite");
  if (options.trace && options.out.empty())
    throw UsageError("--trace writes into the result folder: give --out too");
  if (options.out.empty() && (options.resume || options.overwrite))
    throw UsageError(std::string(options.resume ? "--resume" : "--overwrite") +
                     " needs the folder of an earlier run: give --out too");
  plan.tables = comparison.tables();
  return plan;
}

}  // namespace mssim
