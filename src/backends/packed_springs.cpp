#include "backends/packed_springs.h"

#include <algorithm>
#include <bit>
#include <compare>
#include <limits>
#include <numeric>
#include <span>
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
  std::uint32_t kind, first, second;
  float rest_length;
  auto operator<=>(const Unit&) const = default;
};

std::vector<Unit> sorted_units(const System& system, const std::vector<std::uint32_t>& place) {
  std::vector<Unit> units;
  units.reserve(system.springs.size());
  for (const Spring& spring : system.springs) {
    const auto [low, high] = std::minmax(place[spring.first], place[spring.second]);
    units.push_back({spring.kind, low, high, spring.rest_length});
  }
  std::sort(units.begin(), units.end());
  return units;
}

/// Appends, entry by entry, what each node of a slice has; `nothing` where it has less than another.
void append_slice(std::span<const std::vector<std::uint32_t>> slice, std::uint32_t nothing,
                  std::vector<std::uint32_t>& entries) {
  std::size_t most = 0;
  for (const auto& of_node : slice) most = std::max(most, of_node.size());
  for (std::size_t entry = 0; entry < most; ++entry)
    for (const auto& of_node : slice) entries.push_back(entry < of_node.size() ? of_node[entry] : nothing);
}

}  // namespace

PackedSprings::PackedSprings(const System& system) : scene_node(node_order(system)), place(system.nodes()) {
  constexpr std::size_t largest = std::numeric_limits<std::uint32_t>::max() / 4;
  if (system.springs.size() > largest)
    throw Unsupported("the scene has " + std::to_string(system.springs.size()) +
                      " springs, hybrid numbers at most " + std::to_string(largest));
  for (std::uint32_t i = 0; i < scene_node.size(); ++i) place[scene_node[i]] = i;
  scene_node.resize((scene_node.size() + slice_nodes - 1) / slice_nodes * slice_nodes, no_node);

  std::vector<std::vector<std::uint32_t>> added(places()), subtracted(places());
  const auto add_group = [&](std::uint32_t kind) {
    kinds.push_back(kind);
    units.resize(units.size() + 3 * side_by_side, 0);
  };
  std::uint32_t unit = 0;  // the next one's number
  for (const Unit& spring : sorted_units(system, place)) {
    if (kinds.empty() || kinds.back() != spring.kind || unit == unit_count()) {
      unit = static_cast<std::uint32_t>(unit_count());
      add_group(spring.kind);
    }
    std::uint32_t* at = &units[unit / side_by_side * 3 * side_by_side + unit % side_by_side];
    at[0] = spring.first;
    at[side_by_side] = spring.second;
    at[2 * side_by_side] = std::bit_cast<std::uint32_t>(spring.rest_length);
    added[spring.first].push_back(unit);
    subtracted[spring.second].push_back(unit);
    ++unit;
  }

  const auto nothing = static_cast<std::uint32_t>(unit_count());
  for (std::size_t begin = 0; begin < places(); begin += slice_nodes)
    for (const auto* forces : {&added, &subtracted}) {
      first_entry.push_back(static_cast<std::uint32_t>(entries.size() / slice_nodes));
      append_slice(std::span(*forces).subspan(begin, slice_nodes), nothing, entries);
    }
  first_entry.push_back(static_cast<std::uint32_t>(entries.size() / slice_nodes));
}

}  // namespace mssim
