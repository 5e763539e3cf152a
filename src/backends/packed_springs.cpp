#include "backends/packed_springs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <variant>

#include "backends/backend.h"
#include "backends/sliced_graph/cuthill_mckee.h"

namespace mssim {
namespace {

/// The scene's node at each place.
std::vector<std::uint32_t> node_order(const System& system) {
  if (!std::holds_alternative<GridPatch>(system.topology))
    return reverse_cuthill_mckee(system.nodes(), system.springs);
  std::vector<std::uint32_t> order(system.nodes());
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

/// A spring between places, the lower one first.
struct Unit {
  std::uint32_t first, second;
  float rest_length;
  auto operator<=>(const Unit&) const = default;
};

Unit unit_of(const Spring& spring, const std::vector<std::uint32_t>& place) {
  const auto [low, high] = std::minmax(place[spring.first], place[spring.second]);
  return {low, high, spring.rest_length};
}

/// Calls visit(unit) for the springs of a kind in the order of their units. First ends are found by counting:
/// of a cloth of four million nodes, sorting a copy of all springs took as long as all else four times over.
template <class Visit>
void for_each_sorted(const System& system, const std::vector<std::uint32_t>& place, std::uint32_t kind,
                     Visit&& visit) {
  std::vector<std::uint32_t> end(place.size() + 1, 0);  // of the springs of a first end, shifted by one
  for (const Spring& spring : system.springs)
    if (spring.kind == kind) ++end[unit_of(spring, place).first + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<std::uint32_t> order(end.back());
  for (std::uint32_t s = 0; s < system.springs.size(); ++s)
    if (system.springs[s].kind == kind) order[end[unit_of(system.springs[s], place).first]++] = s;
  std::vector<Unit> of_node;
  for (std::size_t node = 0, begin = 0; node < place.size(); begin = end[node++]) {
    of_node.clear();
    for (std::size_t s = begin; s < end[node]; ++s)
      of_node.push_back(unit_of(system.springs[order[s]], place));
    std::sort(of_node.begin(), of_node.end());
    for (const Unit& unit : of_node) visit(unit);
  }
}

}  // namespace

PackedSprings::PackedSprings(const System& system) : scene_node(node_order(system)), place(system.nodes()) {
  constexpr std::size_t largest = std::numeric_limits<std::uint32_t>::max() / 4;
  if (system.springs.size() > largest)
    throw Unsupported("the scene has " + std::to_string(system.springs.size()) +
                      " springs, hybrid numbers at most " + std::to_string(largest));
  for (std::uint32_t i = 0; i < scene_node.size(); ++i) place[scene_node[i]] = i;
  scene_node.resize((scene_node.size() + slice_nodes - 1) / slice_nodes * slice_nodes, no_node);

  std::vector<std::uint32_t> springs_of_kind(system.materials.size(), 0);
  for (const Spring& spring : system.springs) ++springs_of_kind[spring.kind];
  for (std::uint32_t kind = 0; kind < springs_of_kind.size(); ++kind)
    kinds.insert(kinds.end(), (springs_of_kind[kind] + side_by_side - 1) / side_by_side, kind);
  units.resize(kinds.size() * 3 * side_by_side, 0);

  // [places][added, subtracted] forces of a node.
  std::vector<std::array<std::uint32_t, 2>> forces(places());
  std::size_t unit = 0;  // the next one's number
  for (std::uint32_t kind = 0; kind < springs_of_kind.size(); ++kind) {
    for_each_sorted(system, place, kind, [&](const Unit& spring) {
      std::uint32_t* at = &units[unit / side_by_side * 3 * side_by_side + unit % side_by_side];
      at[0] = spring.first;
      at[side_by_side] = spring.second;
      at[2 * side_by_side] = std::bit_cast<std::uint32_t>(spring.rest_length);
      ++forces[spring.first][0];
      ++forces[spring.second][1];
      ++unit;
    });
    unit = (unit + side_by_side - 1) / side_by_side * side_by_side;
  }
  list_entries(std::move(forces));
}

void PackedSprings::list_entries(std::vector<std::array<std::uint32_t, 2>> forces) {
  first_entry.reserve(2 * slices() + 1);
  first_entry.push_back(0);
  for (std::size_t begin = 0; begin < places(); begin += slice_nodes)
    for (std::size_t side = 0; side < 2; ++side) {
      std::uint32_t most = 0;
      for (std::size_t i = 0; i < slice_nodes; ++i) most = std::max(most, forces[begin + i][side]);
      first_entry.push_back(first_entry.back() + most);
    }
  entries.assign(first_entry.back() * slice_nodes, static_cast<std::uint32_t>(unit_count()));
  std::fill(forces.begin(), forces.end(), std::array<std::uint32_t, 2>{});
  for (std::size_t unit = 0; unit < unit_count(); ++unit) {
    const std::uint32_t* at = &units[unit / side_by_side * 3 * side_by_side + unit % side_by_side];
    const std::array<std::uint32_t, 2> ends{at[0], at[side_by_side]};
    if (ends[0] == ends[1]) continue;  // fills up a kind's last sixteen
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t node = ends[side];
      const std::size_t entry = first_entry[2 * (node / slice_nodes) + side] + forces[node][side]++;
      entries[entry * slice_nodes + node % slice_nodes] = static_cast<std::uint32_t>(unit);
    }
  }
}

}  // namespace mssim
