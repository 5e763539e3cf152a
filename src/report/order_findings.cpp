#include <algorithm>
#include <optional>

#include "report/finding.h"
#include "report/times_as_fast.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Whether the second of two things is faster (1), slower (-1), or neither (0), from size to size.
struct Sides {
  std::vector<int> side;
  std::vector<std::uint64_t> nodes;
};

/// The size from which on the second is faster, where it is not so at smaller ones; none where nothing
/// changes or more than once.
std::optional<std::uint64_t> crossover(const Sides& sides) {
  const auto first = std::ranges::find(sides.side, 1);
  if (first == sides.side.begin() || first == sides.side.end()) return std::nullopt;
  if (!std::all_of(first, sides.side.end(), [](int side) { return side == 1; })) return std::nullopt;
  return sides.nodes[static_cast<std::size_t>(first - sides.side.begin())];
}

/// Counts over sizes and integrators.
struct OrderCount {
  std::uint64_t all = 0, published_faster = 0;
  std::uint64_t as_published = 0, contrary = 0;
  std::uint64_t faster = 0, slower = 0;
  std::vector<std::string> published_crossovers, measured_crossovers;
};

void add_crossover(std::vector<std::string>& list, const Sides& sides, const std::string& integrator) {
  if (const auto nodes = crossover(sides)) list.push_back(grouped(*nodes) + " nodes (" + integrator + ")");
}

OrderCount count_orders(const PaperScenes& scenes, std::string_view first, std::string_view second,
                        const std::string& first_backend, const std::string& second_backend) {
  OrderCount count;
  for (const PaperLegend::Integrator& integrator : scenes.legend().integrators) {
    if (integrator.name != integrator.paper_name) continue;
    Sides published, measured;
    for (const PaperScene& scene : scenes.scenes()) {
      const auto a = scenes.published_ms(scene, integrator.paper_name, first);
      const auto b = scenes.published_ms(scene, integrator.paper_name, second);
      const ResultRow* row = scenes.row(scene, second_backend, integrator.name);
      const ResultRow* than = scenes.row(scene, first_backend, integrator.name);
      const auto ratio = row && than ? times_as_fast(*row, *than) : std::nullopt;
      if (!a || !b || !ratio) continue;
      const int side = side_of_one(*ratio), wanted = *b < *a ? 1 : -1;
      count.all += 1;
      count.published_faster += *b < *a;
      count.as_published += side == wanted;
      count.contrary += side == -wanted;
      count.faster += side == 1;
      count.slower += side == -1;
      published.side.push_back(wanted);
      measured.side.push_back(side);
      published.nodes.push_back(scene.nodes);
      measured.nodes.push_back(scene.nodes);
    }
    add_crossover(count.published_crossovers, published, integrator.name);
    add_crossover(count.measured_crossovers, measured, integrator.name);
  }
  return count;
}

std::string crossovers(const std::vector<std::string>& list) {
  return list.empty() ? "" : " It becomes faster from " + join(list, ", ") + " on.";
}

Finding order_finding(const PaperScenes& scenes, const OrderCount& count, std::string_view first,
                      std::string_view second, const std::string& first_backend,
                      const std::string& second_backend) {
  Finding finding;
  finding.outcome = outcome_of(count.all, count.as_published, count.contrary);
  const std::string of_all = " of " + pluralize(count.all, "combination") + " of size and integrator";
  finding.sentence = scenes.label() + ": " + std::string(caption_of(second)) + " is faster than " +
                     std::string(caption_of(first)) + " in " + std::to_string(count.published_faster) +
                     of_all + "." + crossovers(count.published_crossovers) + " Measured: `" + second_backend +
                     "` is faster than `" + first_backend + "` in " + std::to_string(count.faster) +
                     ", slower in " + std::to_string(count.slower) + ", and cannot be told apart in " +
                     std::to_string(count.all - count.faster - count.slower) + "." +
                     crossovers(count.measured_crossovers);
  return finding;
}

}  // namespace

std::vector<Finding> order_findings(const PaperScenes& scenes) {
  std::vector<Finding> findings;
  for (auto first = paper_configurations.begin(); first != paper_configurations.end(); ++first)
    for (auto second = first + 1; second != paper_configurations.end(); ++second)
      for (const std::string& first_backend : scenes.backends_of(first->name))
        for (const std::string& second_backend : scenes.backends_of(second->name)) {
          const OrderCount count =
              count_orders(scenes, first->name, second->name, first_backend, second_backend);
          if (count.all > 0)
            findings.push_back(
                order_finding(scenes, count, first->name, second->name, first_backend, second_backend));
        }
  return findings;
}

}  // namespace mssim
