#include <optional>

#include "report/finding.h"
#include "report/times_as_fast.h"
#include "text/text.h"

namespace mssim {
namespace {

/// A speed-up at two neighbouring sizes.
struct SizeStep {
  const PaperScene* from = nullptr;
  const PaperScene* to = nullptr;
  std::string integrator;
  double published_from = 1, published_to = 1;
  RatioInterval measured_from, measured_to;

  bool published_falls() const { return published_to < published_from * (1 - published_fall); }
  bool measured_falls() const { return measured_to.high < measured_from.low; }
  bool measured_rises() const { return measured_to.low > measured_from.high; }
};

std::vector<SizeStep> steps_of(const PaperScenes& scenes, std::string_view configuration,
                               const std::string& backend, const std::string& one_thread) {
  std::vector<SizeStep> steps;
  const auto speedup = [&](const PaperScene& scene, const std::string& integrator) {
    const ResultRow* row = scenes.row(scene, backend, integrator);
    const ResultRow* base = scenes.row(scene, one_thread, integrator);
    return row && base ? times_as_fast(*row, *base) : std::nullopt;
  };
  for (const PaperLegend::Integrator& integrator : scenes.legend().integrators) {
    if (integrator.name != integrator.paper_name) continue;
    for (std::size_t i = 1; i < scenes.scenes().size(); ++i) {
      const PaperScene &from = scenes.scenes()[i - 1], &to = scenes.scenes()[i];
      const auto published_from = scenes.published_speedup(from, integrator.name, configuration);
      const auto published_to = scenes.published_speedup(to, integrator.name, configuration);
      const auto measured_from = speedup(from, integrator.name), measured_to = speedup(to, integrator.name);
      if (published_from && published_to && measured_from && measured_to)
        steps.push_back(
            {&from, &to, integrator.name, *published_from, *published_to, *measured_from, *measured_to});
    }
  }
  return steps;
}

std::string from_to(double from, double to) { return three_digits(from) + "× to " + three_digits(to) + "×"; }

Finding trend_finding(const PaperScenes& scenes, const std::vector<SizeStep>& steps,
                      std::string_view configuration, const std::string& backend) {
  std::uint64_t falls = 0, also_falls = 0, rises = 0, any_falls = 0;
  const SizeStep* deepest = nullptr;
  for (const SizeStep& step : steps) {
    any_falls += step.measured_falls();
    if (!step.published_falls()) continue;
    falls += 1;
    also_falls += step.measured_falls();
    rises += step.measured_rises();
    if (!deepest || step.published_to / step.published_from < deepest->published_to / deepest->published_from)
      deepest = &step;
  }
  const std::string caption(caption_of(configuration)), of_steps = pluralize(steps.size(), "step");
  if (!deepest)
    return {any_falls == 0 ? Outcome::reproduced : Outcome::not_reproduced,
            scenes.label() + ": the speed-up of " + caption +
                " never falls from one size to the next. Measured: that of `" + backend + "` falls in " +
                std::to_string(any_falls) + " of " + of_steps + "."};
  const std::string what = deepest->measured_falls()   ? "falls, too"
                           : deepest->measured_rises() ? "rises"
                                                       : "does not certainly change";
  return {outcome_of(falls, also_falls, rises),
          scenes.label() + ": the speed-up of " + caption + " falls in " + std::to_string(falls) + " of " +
              of_steps + " from one size to the next, most from " + grouped(deepest->from->nodes) + " to " +
              grouped(deepest->to->nodes) + " nodes with " + deepest->integrator + " (" +
              from_to(deepest->published_from, deepest->published_to) + "). There the measured one of `" +
              backend + "` " + what + " (" +
              from_to(deepest->measured_from.ratio, deepest->measured_to.ratio) +
              "). Of all the published falls it follows " + std::to_string(also_falls) + ", rises in " +
              std::to_string(rises) + ", and is undecided in " + std::to_string(falls - also_falls - rises) +
              "."};
}

}  // namespace

std::vector<Finding> trend_findings(const PaperScenes& scenes) {
  std::vector<Finding> findings;
  const std::vector<std::string> one_thread = scenes.backends_of(one_thread_configuration);
  if (one_thread.empty()) return findings;
  for (const PaperConfiguration& configuration : paper_configurations) {
    if (configuration.name == one_thread_configuration) continue;
    for (const std::string& backend : scenes.backends_of(configuration.name)) {
      const auto steps = steps_of(scenes, configuration.name, backend, one_thread.front());
      if (!steps.empty()) findings.push_back(trend_finding(scenes, steps, configuration.name, backend));
    }
  }
  return findings;
}

}  // namespace mssim
