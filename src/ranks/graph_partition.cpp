#include <fmt/core.h>
#include <metis.h>

#include <array>
#include <limits>
#include <numeric>
#include <string>

#include "backends/layouts/spring_graph.h"
#include "ranks/shares.h"

namespace mssim {
namespace {

std::string reason_of(int result) {
  if (result == METIS_ERROR_MEMORY) return "it has too little memory";
  if (result == METIS_ERROR_INPUT) return "it rejects the graph";
  return fmt::format("error {}", result);
}

[[noreturn]] void fail(std::size_t nodes, std::size_t parts, const std::string& reason) {
  throw RankFailure(
      fmt::format("METIS cannot cut a body of {} nodes into {} parts: {}", nodes, parts, reason));
}

/// Gives every empty part a node of the largest part, the one with the fewest neighbours there. METIS leaves
/// parts empty if they are to have only a few nodes.
void fill_empty_parts(const Adjacency& graph, std::size_t parts, std::vector<std::uint32_t>& part_of) {
  std::vector<std::size_t> nodes_of(parts, 0);
  for (const std::uint32_t part : part_of) ++nodes_of[part];
  for (std::uint32_t part = 0; part < parts; ++part) {
    if (nodes_of[part] > 0) continue;
    const auto largest = static_cast<std::uint32_t>(std::ranges::max_element(nodes_of) - nodes_of.begin());
    auto fewest = std::numeric_limits<std::ptrdiff_t>::max();
    std::uint32_t chosen = 0;
    for (std::uint32_t node = 0; node < part_of.size(); ++node) {
      if (part_of[node] != largest) continue;
      const auto inside =
          std::ranges::count(graph.of(node), largest, [&](std::uint32_t other) { return part_of[other]; });
      if (inside >= fewest) continue;
      fewest = inside;
      chosen = node;
    }
    part_of[chosen] = part;
    --nodes_of[largest];
    ++nodes_of[part];
  }
}

}  // namespace

std::vector<std::uint32_t> graph_partition(std::size_t nodes, std::span<const Spring> springs,
                                           std::span<const std::size_t> shares) {
  const std::size_t parts = shares.size();
  if (parts == 1) return std::vector<std::uint32_t>(nodes, 0);
  // Cost of a node: its springs, and its share of a slice's fixed cost.
  const std::size_t own_cost = cost_of_slices_before({0, 0}, 1);
  // METIS adds up the costs in its integer type.
  if (2 * springs.size() + own_cost * nodes > static_cast<std::size_t>(std::numeric_limits<idx_t>::max()))
    fail(nodes, parts, "it has too many springs");
  const Adjacency graph(nodes, springs);
  std::vector<idx_t> first(graph.first.begin(), graph.first.end());
  std::vector<idx_t> neighbours(graph.items.begin(), graph.items.end());
  std::vector<idx_t> cost;
  for (std::uint32_t node = 0; node < nodes; ++node)
    cost.push_back(static_cast<idx_t>(own_cost + graph.degree(node)));
  const auto all = static_cast<double>(std::reduce(shares.begin(), shares.end()));
  std::vector<real_t> wanted;
  for (const std::size_t share : shares)
    wanted.push_back(static_cast<real_t>(static_cast<double>(share) / all));
  std::array<idx_t, METIS_NOPTIONS> options{};
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = 1;
  auto node_count = static_cast<idx_t>(nodes), constraints = idx_t{1};
  auto part_count = static_cast<idx_t>(parts);
  idx_t cut = 0;
  std::vector<idx_t> found(nodes, 0);
  const int result =
      METIS_PartGraphKway(&node_count, &constraints, first.data(), neighbours.data(), cost.data(), nullptr,
                          nullptr, &part_count, wanted.data(), nullptr, options.data(), &cut, found.data());
  if (result != METIS_OK) fail(nodes, parts, reason_of(result));
  std::vector<std::uint32_t> part_of(found.begin(), found.end());
  fill_empty_parts(graph, parts, part_of);
  return part_of;
}

}  // namespace mssim
