#include "backends/layouts/sliced_graph.h"

#include <algorithm>
#include <string>
#include <utility>

#include "backends/interface/backend.h"
#include "backends/layouts/cuthill_mckee.h"
#include "backends/layouts/spring_constants.h"

namespace mssim {
namespace {

/// The kind of each node's springs; no_node where it has none. Throws Unsupported where a node has several.
std::vector<std::uint32_t> kind_of_nodes(const System& system) {
  std::vector<std::uint32_t> kinds(system.nodes(), SlicedGraph::no_node);
  for (const Spring& spring : system.springs)
    for (const std::uint32_t node : {spring.first, spring.second}) {
      if (kinds[node] == SlicedGraph::no_node) kinds[node] = spring.kind;
      if (kinds[node] != spring.kind)
        throw Unsupported("springs of different materials meet in node " + std::to_string(node) +
                          "; this backend needs bodies of one material each");
    }
  return kinds;
}

struct Neighbour {
  std::uint32_t slot;
  float rest_length;
};

}  // namespace

SlicedGraph::SlicedGraph(const System& system, std::size_t slice_lanes)
    : lanes(slice_lanes), slot(system.nodes()) {
  if (system.springs.size() > no_node / 2)
    throw Unsupported("the scene has " + std::to_string(system.springs.size()) +
                      " springs; a sliced graph holds at most 2147483647");
  const std::vector<std::uint32_t> kinds = kind_of_nodes(system);
  std::vector<std::uint32_t> degree(system.nodes(), 0);
  for (const Spring& spring : system.springs) {
    ++degree[spring.first];
    ++degree[spring.second];
  }

  scene_node = reverse_cuthill_mckee(system.nodes(), system.springs);
  for (std::size_t begin = 0; begin < nodes(); begin += window)
    std::stable_sort(scene_node.begin() + static_cast<std::ptrdiff_t>(begin),
                     scene_node.begin() + static_cast<std::ptrdiff_t>(std::min(begin + window, nodes())),
                     [&](std::uint32_t a, std::uint32_t b) { return degree[a] > degree[b]; });
  for (std::uint32_t i = 0; i < nodes(); ++i) slot[scene_node[i]] = i;
  scene_node.resize((nodes() + lanes - 1) / lanes * lanes, no_node);

  std::vector<std::vector<Neighbour>> springs(slots());
  for (std::uint32_t node = 0; node < nodes(); ++node) springs[slot[node]].reserve(degree[node]);
  for (const Spring& spring : system.springs) {
    springs[slot[spring.first]].push_back({slot[spring.second], spring.rest_length});
    springs[slot[spring.second]].push_back({slot[spring.first], spring.rest_length});
  }
  first_entry.assign(1, 0);
  for (std::size_t begin = 0; begin < slots(); begin += lanes) {
    std::size_t largest = 0;
    for (std::size_t i = begin; i < begin + lanes; ++i) {
      std::sort(springs[i].begin(), springs[i].end(),
                [](const Neighbour& a, const Neighbour& b) { return a.slot < b.slot; });
      largest = std::max(largest, springs[i].size());
    }
    first_entry.push_back(first_entry.back() + static_cast<std::uint32_t>(largest));
  }

  neighbour.resize(entries() * lanes);
  stiffness_rest.assign(entries() * lanes, empty_entry);
  stiffness.assign(slots(), 0);
  damping.assign(slots(), 0);
  held.assign(slots(), 0);
  for (std::size_t i = 0; i < slots(); ++i) {
    const std::size_t slice = i / lanes;
    for (std::size_t e = first_entry[slice]; e < first_entry[slice + 1]; ++e)
      neighbour[e * lanes + i % lanes] = static_cast<std::uint32_t>(i);
    if (scene_node[i] == no_node) held[i] = 1;
    if (springs[i].empty()) continue;
    const SpringMaterial& material = system.materials[kinds[scene_node[i]]];
    const double mass = system.node_mass[scene_node[i]];
    std::size_t element = first_entry[slice] * lanes + i % lanes;
    for (const Neighbour& other : springs[i]) {
      const SpringConstants spring(material, static_cast<double>(other.rest_length), mass);
      stiffness[i] = spring.stiffness;
      damping[i] = spring.damping;
      neighbour[element] = other.slot;
      stiffness_rest[element] = spring.stiffness_rest;
      element += lanes;
    }
  }
  for (const std::uint32_t pin : system.pins) held[slot[pin]] = 1;
}

}  // namespace mssim
