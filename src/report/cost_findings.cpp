#include <algorithm>
#include <cmath>
#include <optional>

#include "report/finding.h"
#include "report/times_as_fast.h"
#include "statistics/statistics.h"
#include "text/text.h"

namespace mssim {
namespace {

/// What a step costs, in steps of the cheapest integrator, over the sizes of a table.
struct StepCosts {
  double mean = 1, least = 1, most = 1;  ///< the geometric mean, and the range
  std::uint64_t cheaper = 0;             ///< sizes at which it costs less than the cheapest
  std::uint64_t sizes = 0;
};

std::optional<StepCosts> summary_of(const std::vector<double>& ratios) {
  if (ratios.empty()) return std::nullopt;
  const auto cheaper = std::ranges::count_if(ratios, [](double ratio) { return ratio < 1; });
  return StepCosts{geometric_mean(ratios), std::ranges::min(ratios), std::ranges::max(ratios),
                   static_cast<std::uint64_t>(cheaper), ratios.size()};
}

std::optional<StepCosts> published_costs(const PaperScenes& scenes, const std::string& integrator,
                                         const std::string& cheapest, std::string_view configuration) {
  std::vector<double> ratios;
  for (const PaperScene& scene : scenes.scenes()) {
    const auto ms = scenes.published_ms(scene, integrator, configuration);
    const auto base = scenes.published_ms(scene, cheapest, configuration);
    if (ms && base) ratios.push_back(*ms / *base);
  }
  return summary_of(ratios);
}

std::optional<StepCosts> measured_costs(const PaperScenes& scenes, const std::string& integrator,
                                        const std::string& cheapest, const std::string& backend) {
  std::vector<double> ratios;
  for (const PaperScene& scene : scenes.scenes()) {
    const ResultRow* row = scenes.row(scene, backend, integrator);
    const ResultRow* base = scenes.row(scene, backend, cheapest);
    if (const auto ratio = row && base ? times_as_fast(*base, *row) : std::nullopt)
      ratios.push_back(ratio->ratio);
  }
  return summary_of(ratios);
}

bool is_like(const StepCosts& measured, const StepCosts& published) {
  return std::abs(std::log(measured.mean / published.mean)) <= std::log(cost_tolerance);
}

std::string range_of(const StepCosts& costs) {
  const std::string below = costs.cheaper == 0 ? ""
                                               : ", below 1 at " + std::to_string(costs.cheaper) + " of " +
                                                     pluralize(costs.sizes, "size");
  return three_digits(costs.mean) + " (" + three_digits(costs.least) + " to " + three_digits(costs.most) +
         below + ")";
}

/// What a published cost suggests of a method that evaluates the forces so many times.
std::string suggestion(const StepCosts& published, int evaluations) {
  const double log_cost = std::log(published.mean), log_all = std::log(static_cast<double>(evaluations));
  return std::abs(log_cost) < std::abs(log_cost - log_all)
             ? "about what one force evaluation costs, though the method has " +
                   pluralize(static_cast<std::uint64_t>(evaluations), "force evaluation")
             : "about what its " + pluralize(static_cast<std::uint64_t>(evaluations), "force evaluation") +
                   " cost";
}

}  // namespace

std::vector<Finding> cost_findings(const PaperScenes& scenes) {
  std::vector<Finding> findings;
  const auto& integrators = scenes.legend().integrators;
  if (integrators.empty()) return findings;
  const std::string cheapest = integrators.front().name;
  for (const PaperLegend::Integrator& integrator : integrators) {
    if (integrator.paper_name == cheapest) continue;
    // The published method; one that holds forces stands for the same.
    const auto method = std::ranges::find(integrators, integrator.paper_name, &PaperLegend::Integrator::name);
    const int evaluations = (method == integrators.end() ? integrator : *method).force_evaluations;
    for (const PaperConfiguration& configuration : paper_configurations) {
      const auto published = published_costs(scenes, integrator.paper_name, cheapest, configuration.name);
      if (!published) continue;
      std::vector<std::string> costs;
      std::size_t alike = 0;
      for (const std::string& backend : scenes.backends_of(configuration.name))
        if (const auto measured = measured_costs(scenes, integrator.name, cheapest, backend)) {
          costs.push_back("`" + backend + "` " + range_of(*measured));
          alike += is_like(*measured, *published);
        }
      if (costs.empty()) continue;
      const Outcome outcome = alike == costs.size() ? Outcome::reproduced
                              : alike == 0          ? Outcome::not_reproduced
                                                    : Outcome::partly;
      findings.push_back(
          {outcome,
           scenes.label() + ": with " + std::string(configuration.caption) + " a step of " +
               integrator.paper_name + " costs " + range_of(*published) + " steps of " + cheapest + ", " +
               suggestion(*published, evaluations) + ". Measured, `" + integrator.name + "` with " +
               pluralize(static_cast<std::uint64_t>(integrator.force_evaluations), "force evaluation") +
               ": " + join(costs, ", ") + "."});
    }
  }
  return findings;
}

}  // namespace mssim
