#include "backends/layouts/spring_graph.h"

#include <bit>
#include <numeric>

namespace mssim {
namespace {

/// A peripheral node of the component of `node`: the farthest one, of least degree among those, from the
/// farthest one, and so on until the distance no longer grows (A. George and J. Liu, 1979). `distance` must
/// be `unreached` for the component's nodes, and is so again afterwards.
std::uint32_t rim_node(const Adjacency& graph, std::uint32_t node, std::vector<std::uint32_t>& distance,
                       std::uint32_t unreached) {
  std::vector<std::uint32_t> queue;
  for (std::uint32_t eccentricity = 0;;) {
    queue.assign(1, node);
    distance[node] = 0;
    for (std::size_t i = 0; i < queue.size(); ++i)
      for (const std::uint32_t other : graph.of(queue[i]))
        if (distance[other] == unreached) {
          distance[other] = distance[queue[i]] + 1;
          queue.push_back(other);
        }
    const std::uint32_t farthest = distance[queue.back()];
    std::uint32_t candidate = queue.back();
    for (const std::uint32_t other : queue)
      if (distance[other] == farthest && graph.degree(other) < graph.degree(candidate)) candidate = other;
    for (const std::uint32_t other : queue) distance[other] = unreached;
    if (farthest <= eccentricity) return node;
    eccentricity = farthest;
    node = candidate;
  }
}

}  // namespace

std::vector<std::uint32_t> degrees_of(std::size_t nodes, std::span<const Spring> springs) {
  std::vector<std::uint32_t> degree(nodes, 0);
  for (const Spring& spring : springs) {
    ++degree[spring.first];
    ++degree[spring.second];
  }
  return degree;
}

std::vector<std::uint32_t> reverse_cuthill_mckee(std::size_t nodes, std::span<const Spring> springs) {
  const Adjacency graph(nodes, springs);
  const auto none = static_cast<std::uint32_t>(nodes);
  std::vector<std::uint32_t> order, distance(nodes, none);
  std::vector<bool> placed(nodes, false);
  order.reserve(nodes);
  for (std::uint32_t lowest = 0; lowest < none; ++lowest) {
    if (placed[lowest]) continue;
    const std::size_t component = order.size();
    order.push_back(rim_node(graph, lowest, distance, none));
    placed[order.back()] = true;
    for (std::size_t i = component; i < order.size(); ++i) {
      const std::size_t children = order.size();
      for (const std::uint32_t other : graph.of(order[i]))
        if (!placed[other]) {
          placed[other] = true;
          order.push_back(other);
        }
      std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(children), order.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return graph.degree(a) < graph.degree(b); });
    }
    std::reverse(order.begin() + static_cast<std::ptrdiff_t>(component), order.end());
  }
  return order;
}

std::vector<std::uint32_t> places_in(std::span<const std::uint32_t> order) {
  std::vector<std::uint32_t> place(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  return place;
}

std::vector<std::size_t> component_ends(std::span<const Spring> springs,
                                        std::span<const std::uint32_t> place) {
  std::vector<std::size_t> reach(place.size());  // [places] farthest place that springs reach from here
  std::iota(reach.begin(), reach.end(), std::size_t{0});
  for (const Spring& spring : springs) {
    const auto [near, far] = std::minmax(place[spring.first], place[spring.second]);
    reach[near] = std::max<std::size_t>(reach[near], far);
  }
  std::vector<std::size_t> ends;
  for (std::size_t i = 0, farthest = 0; i < reach.size(); ++i) {
    farthest = std::max(farthest, reach[i]);
    if (farthest == i) ends.push_back(i + 1);
  }
  return ends;
}

SpringsByFirstEnd::SpringsByFirstEnd(std::span<const Spring> springs, std::span<const std::uint32_t> slot,
                                     std::span<const std::uint32_t> rank)
    : slot_(slot), rank_(rank), by_slot_(slot.size(), [&](const auto& visit) {
        for (std::uint32_t s = 0; s < springs.size(); ++s) visit(first_slot(springs[s]), s);
      }) {}

SpringColouring colour_springs(std::span<const Spring> list, std::size_t nodes) {
  constexpr std::size_t word_bits = 64;
  const std::vector<std::uint32_t> degree = degrees_of(nodes, list);
  const std::size_t largest = degree.empty() ? 0 : *std::ranges::max_element(degree);
  const std::size_t words = (2 * largest + word_bits - 1) / word_bits;
  std::vector<std::uint64_t> taken(nodes * words, 0);  // [nodes][words] one bit for each colour at a node
  std::vector<std::uint32_t> colour_of;
  colour_of.reserve(list.size());
  std::size_t colours = 0;
  for (const Spring& spring : list) {
    std::uint64_t* const first = &taken[spring.first * words];
    std::uint64_t* const second = &taken[spring.second * words];
    std::size_t word = 0;
    while (~(first[word] | second[word]) == 0) ++word;
    const auto bit = static_cast<std::size_t>(std::countr_one(first[word] | second[word]));
    first[word] |= std::uint64_t{1} << bit;
    second[word] |= std::uint64_t{1} << bit;
    const std::size_t colour = word * word_bits + bit;
    colour_of.push_back(static_cast<std::uint32_t>(colour));
    colours = std::max(colours, colour + 1);
  }
  return {colours, [&](const auto& visit) {
            for (std::size_t s = 0; s < list.size(); ++s) visit(colour_of[s], list[s]);
          }};
}

}  // namespace mssim
