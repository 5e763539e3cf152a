#include "backends/layouts/packed_springs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <numeric>
#include <utility>
#include <variant>

#include "backends/layouts/node_arrays.h"
#include "backends/layouts/spring_graph.h"

namespace mssim {
namespace {

/// A spring between slots, from its first end.
struct Unit {
  std::uint32_t kind, second;
  float rest_length;
  // clang-tidy 14 mistakes its implied comparison with zero for one with a null pointer.
  auto operator<=>(const Unit&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// The scene's node at each slot, and each scene node's rank: a spring's first end is the one of lower rank.
struct NodeOrder {
  std::vector<std::uint32_t> scene_node, rank;
};

NodeOrder node_order(const System& system) {
  NodeOrder order;
  if (std::holds_alternative<GridPatch>(system.topology)) {
    order.rank.resize(system.nodes());
    std::iota(order.rank.begin(), order.rank.end(), 0U);
    order.scene_node = order.rank;
    return order;
  }
  std::vector<std::uint32_t>& node = order.scene_node;
  node = reverse_cuthill_mckee(system.nodes(), system.springs);
  order.rank = places_in(node);

  std::vector<std::array<std::uint32_t, 2>> forces(system.nodes());  // [nodes] added, subtracted
  for (const Spring& spring : system.springs) {
    const bool in_order = order.rank[spring.first] < order.rank[spring.second];
    ++forces[spring.first][in_order ? 0 : 1];
    ++forces[spring.second][in_order ? 1 : 0];
  }
  for (std::size_t begin = 0; begin < node.size(); begin += PackedSprings::window) {
    const std::size_t end = std::min(begin + PackedSprings::window, node.size());
    std::stable_sort(node.begin() + static_cast<std::ptrdiff_t>(begin),
                     node.begin() + static_cast<std::ptrdiff_t>(end),
                     [&](std::uint32_t a, std::uint32_t b) { return forces[a] > forces[b]; });
  }
  return order;
}

/// The units that begin at a slot, sorted by kind, then by second end.
void find_units(const System& system, const SpringsByFirstEnd& springs, std::size_t slot,
                std::vector<Unit>& units) {
  units.clear();
  for (const std::uint32_t number : springs.at(slot)) {
    const Spring& spring = system.springs[number];
    units.push_back({spring.kind, springs.second_slot(spring), spring.rest_length});
  }
  std::sort(units.begin(), units.end());
}

}  // namespace

PackedSprings::PackedSprings(const System& system) {
  constexpr std::size_t largest = std::numeric_limits<std::uint32_t>::max() / slice_nodes;
  if (system.springs.size() > largest)
    throw Unsupported("the scene has {} springs; hybrid supports at most {}", system.springs.size(), largest);
  NodeOrder order = node_order(system);
  scene_node = std::move(order.scene_node);
  slot = places_in(scene_node);
  scene_node.resize(round_up(scene_node.size(), slice_nodes), no_node);

  pack_units(system, order.rank);
  list_subtracted();
}

void PackedSprings::pack_units(const System& system, const std::vector<std::uint32_t>& rank) {
  const SpringsByFirstEnd springs(system.springs, slot, rank);
  constexpr std::uint32_t no_kind = std::numeric_limits<std::uint32_t>::max();
  std::array<std::vector<Unit>, slice_nodes> of_node;
  first_entry.push_back(0);
  for (std::uint32_t slice = 0; slice < slots() / slice_nodes; ++slice) {
    for (std::size_t i = 0; i < slice_nodes; ++i)
      find_units(system, springs, slice * slice_nodes + i, of_node[i]);
    std::array<std::size_t, slice_nodes> next{};
    while (true) {
      // One kind after the other, each until no node of the slice has one left.
      std::uint32_t kind = no_kind;
      for (std::size_t i = 0; i < slice_nodes; ++i)
        if (next[i] < of_node[i].size()) kind = std::min(kind, of_node[i][next[i]].kind);
      if (kind == no_kind) break;
      std::array<std::uint32_t, 2 * slice_nodes> entry{};
      for (std::uint32_t i = 0; i < slice_nodes; ++i) {
        const bool has = next[i] < of_node[i].size() && of_node[i][next[i]].kind == kind;
        const std::uint32_t own = slice * static_cast<std::uint32_t>(slice_nodes) + i;
        const Unit unit = has ? of_node[i][next[i]++] : Unit{kind, own, empty_unit};
        entry[i] = unit.second;
        entry[slice_nodes + i] = std::bit_cast<std::uint32_t>(unit.rest_length);
      }
      entries.push_back({slice, kind});
      units.insert(units.end(), entry.begin(), entry.end());
    }
    first_entry.push_back(static_cast<std::uint32_t>(entries.size()));
  }
}

void PackedSprings::list_subtracted() {
  const auto for_each_force = [&](auto&& visit) {
    for (std::size_t entry = 0; entry < entries.size(); ++entry)
      for (std::size_t i = 0; i < slice_nodes; ++i) {
        const std::uint32_t* unit = units.data() + entry * 2 * slice_nodes + i;
        if (std::bit_cast<float>(unit[slice_nodes]) != empty_unit)
          visit(unit[0], static_cast<std::uint32_t>(entry * slice_nodes + force_place(i)));
      }
  };
  std::vector<std::uint32_t> received(slots(), 0);
  for_each_force([&](std::uint32_t node, std::uint32_t) { ++received[node]; });
  first_subtracted.push_back(0);
  for (auto node = received.begin(); node != received.end(); node += list_nodes)
    first_subtracted.push_back(first_subtracted.back() + *std::max_element(node, node + list_nodes));
  subtracted.assign(std::size_t{first_subtracted.back()} * list_nodes, no_force());
  std::fill(received.begin(), received.end(), 0);
  for_each_force([&](std::uint32_t node, std::uint32_t force) {
    const std::size_t entry = first_subtracted[node / list_nodes] + received[node]++;
    subtracted[entry * list_nodes + node % list_nodes] = force;
  });
}

AlikeSprings::AlikeSprings(const std::vector<AlikeBodies>& bodies) : slices(bodies, slice_nodes) {
  for (const AlikeBodies& of : bodies) shapes.push_back(of.constants);
  std::size_t count = 0;
  for (const AlikeSlices::Group& group : slices.groups) count += bodies[group.shape].springs.size();
  constexpr std::size_t largest = std::numeric_limits<std::uint32_t>::max() / slice_nodes;
  if (count > largest)
    throw Unsupported("the scene has {} springs for each lane; hybrid supports at most {}", count, largest);
  springs.reserve(count);
  for (const AlikeSlices::Group& group : slices.groups) {
    const AlikeBodies& of = bodies[group.shape];
    const auto slice = static_cast<std::uint32_t>(group.first_slice);
    pinned.insert(pinned.end(), of.pinned.begin(), of.pinned.end());
    for (std::uint32_t node = 0; node < of.nodes(); ++node) {
      first_end.push_back(static_cast<std::uint32_t>(springs.size()));
      for (std::uint32_t s = of.first_spring[node]; s < of.first_spring[node + 1]; ++s) {
        const AlikeBodies::SpringAhead& spring = of.springs[s];
        springs.push_back({slice + node, slice + spring.other, spring.stiffness_rest,
                           static_cast<std::uint32_t>(group.shape)});
      }
    }
  }
  first_end.push_back(static_cast<std::uint32_t>(springs.size()));

  subtracted = Grouped<std::uint32_t>(slices.count, [&](const auto& visit) {
    for (std::uint32_t s = 0; s < springs.size(); ++s) visit(springs[s].second, s);
  });
}

}  // namespace mssim
