#include "backends/layouts/sliced_graph.h"

#include <algorithm>
#include <span>

#include "backends/interface/backend.h"
#include "backends/layouts/spring_graph.h"

namespace mssim {
namespace {

/// The kind of each node's springs; no_node without springs. Throws Unsupported if a node has several kinds.
std::vector<std::uint32_t> kind_of_nodes(const System& system) {
  std::vector<std::uint32_t> kinds(system.nodes(), SlicedGraph::no_node);
  for (const Spring& spring : system.springs)
    for (const std::uint32_t node : {spring.first, spring.second}) {
      if (kinds[node] == SlicedGraph::no_node) kinds[node] = spring.kind;
      if (kinds[node] != spring.kind)
        throw Unsupported(
            "springs of different materials meet in node {}; this backend needs bodies of one material each",
            node);
    }
  return kinds;
}

struct Neighbour {
  std::uint32_t node;
  float rest_length;
};

/// Sorts nodes within windows by degree, the largest first.
void sort_in_windows(std::span<std::uint32_t> nodes, const std::vector<std::uint32_t>& degree) {
  for (std::size_t begin = 0; begin < nodes.size(); begin += SlicedGraph::window) {
    const std::size_t count = std::min(SlicedGraph::window, nodes.size() - begin);
    std::ranges::stable_sort(nodes.subspan(begin, count), std::ranges::greater{},
                             [&](std::uint32_t node) { return degree[node]; });
  }
}

/// A whole system as a part of itself.
GraphPart whole_of(const System& system) {
  if (system.springs.size() > SlicedGraph::no_node / 2)
    throw Unsupported("the scene has {} springs; a sliced graph holds at most 2147483647",
                      system.springs.size());
  return {places_in(reverse_cuthill_mckee(system.nodes(), system.springs)), system.nodes()};
}

/// Whether each own node of a part has a ghost as a neighbour.
std::vector<bool> edge_nodes(const System& system, std::size_t own) {
  std::vector<bool> edge(own, false);
  for (const Spring& spring : system.springs) {
    if (spring.first < own && spring.second >= own) edge[spring.first] = true;
    if (spring.second < own && spring.first >= own) edge[spring.second] = true;
  }
  return edge;
}

}  // namespace

template <class Real>
SlicedGraphOf<Real>::SlicedGraphOf(const System& system, std::size_t slice_lanes)
    : SlicedGraphOf(system, slice_lanes, whole_of(system)) {}

template <class Real>
SlicedGraphOf<Real>::SlicedGraphOf(const System& system, std::size_t slice_lanes, const GraphPart& part)
    : lanes(slice_lanes), slot(system.nodes()), ghosts(system.nodes() - part.own) {
  const std::vector<std::uint32_t> kinds = kind_of_nodes(system);
  const std::vector<std::uint32_t> degree = degrees_of(system.nodes(), system.springs);
  std::vector<std::uint32_t> inner, at_edge;
  const std::vector<bool> edge = edge_nodes(system, part.own);
  for (std::uint32_t node = 0; node < part.own; ++node) (edge[node] ? at_edge : inner).push_back(node);
  const auto append = [&](std::vector<std::uint32_t>& group) {
    std::ranges::sort(group, {}, [&](std::uint32_t node) { return part.place[node]; });
    sort_in_windows(group, degree);
    scene_node.insert(scene_node.end(), group.begin(), group.end());
    scene_node.resize(round_up(scene_node.size(), lanes), no_node);
  };
  append(inner);
  first_edge_slice = slots() / lanes;
  append(at_edge);
  for (std::uint32_t i = 0; i < slots(); ++i)
    if (scene_node[i] != no_node) slot[scene_node[i]] = i;
  for (std::size_t ghost = 0; ghost < ghosts; ++ghost)
    slot[part.own + ghost] = static_cast<std::uint32_t>(slots() + ghost);

  std::vector<std::vector<Neighbour>> springs(slots());
  for (std::uint32_t node = 0; node < part.own; ++node) springs[slot[node]].reserve(degree[node]);
  for (const Spring& spring : system.springs) {
    if (spring.first < part.own) springs[slot[spring.first]].push_back({spring.second, spring.rest_length});
    if (spring.second < part.own) springs[slot[spring.second]].push_back({spring.first, spring.rest_length});
  }
  first_entry.assign(1, 0);
  for (std::size_t begin = 0; begin < slots(); begin += lanes) {
    std::size_t largest = 0;
    for (std::size_t i = begin; i < begin + lanes; ++i) {
      std::ranges::sort(springs[i], {}, [&](const Neighbour& other) { return part.place[other.node]; });
      largest = std::max(largest, springs[i].size());
    }
    first_entry.push_back(first_entry.back() + static_cast<std::uint32_t>(largest));
  }

  neighbour.resize(entries() * lanes);
  stiffness_rest.assign(entries() * lanes, empty_entry);
  constants.resize(slots());
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
      const auto spring = spring_per_mass<Real>(material, static_cast<double>(other.rest_length), mass);
      constants[i] = spring.constants;
      neighbour[element] = slot[other.node];
      stiffness_rest[element] = spring.stiffness_rest;
      element += lanes;
    }
  }
  for (const std::uint32_t pin : system.pins)
    if (pin < part.own) held[slot[pin]] = 1;
}

template struct SlicedGraphOf<float>;
template struct SlicedGraphOf<double>;

void require_nameable_records(const System& system, std::size_t floats_of_record) {
  const std::size_t most_nodes = std::numeric_limits<std::uint32_t>::max() /
                                 (floats_of_record / slice_offset_unit<float>)-SlicedGraph::window;
  if (system.nodes() > most_nodes)
    throw Unsupported("the scene has {} nodes; openmp supports bodies of at most {}", system.nodes(),
                      most_nodes);
}

}  // namespace mssim
