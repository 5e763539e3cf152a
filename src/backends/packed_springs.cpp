#include "backends/packed_springs.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <variant>

#include "backends/backend.h"
#include "backends/sliced_graph/cuthill_mckee.h"

namespace mssim {
namespace {

/// A spring between places.
struct Unit {
  std::uint32_t first, second, kind;
  float rest_length;
};

/// Where each of a list's items is, given how often each appears: [counts + 1], the last one is the sum.
std::vector<std::uint32_t> beginnings(const std::vector<std::uint32_t>& counts) {
  std::vector<std::uint32_t> begin(counts.size() + 1, 0);
  std::partial_sum(counts.begin(), counts.end(), begin.begin() + 1);
  return begin;
}

/// The scene's node at each place, and for each scene's node how far ahead it is: the end of a spring that is
/// further ahead is its first.
struct NodeOrder {
  std::vector<std::uint32_t> scene_node, rank;
};

NodeOrder node_order(const System& system) {
  NodeOrder order;
  order.rank.resize(system.nodes());
  if (std::holds_alternative<GridPatch>(system.topology)) {
    std::iota(order.rank.begin(), order.rank.end(), 0U);
    order.scene_node = order.rank;
    return order;
  }
  std::vector<std::uint32_t>& node = order.scene_node;
  node = reverse_cuthill_mckee(system.nodes(), system.springs);
  for (std::uint32_t i = 0; i < node.size(); ++i) order.rank[node[i]] = i;

  std::vector<std::array<std::uint32_t, 2>> forces(system.nodes());  // added, subtracted
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

std::vector<Unit> sorted_units(const System& system, const std::vector<std::uint32_t>& place,
                               const std::vector<std::uint32_t>& rank) {
  std::vector<Unit> units;
  units.reserve(system.springs.size());
  for (const Spring& spring : system.springs) {
    auto [first, second] = std::pair(spring.first, spring.second);
    if (rank[first] > rank[second]) std::swap(first, second);
    units.push_back({place[first], place[second], spring.kind, spring.rest_length});
  }
  std::sort(units.begin(), units.end(), [](const Unit& a, const Unit& b) {
    return std::tie(a.first, a.kind, a.second) < std::tie(b.first, b.kind, b.second);
  });
  return units;
}

}  // namespace

PackedSprings::PackedSprings(const System& system) : place(system.nodes()) {
  constexpr std::size_t largest = std::numeric_limits<std::uint32_t>::max() / slice_nodes;
  if (system.springs.size() > largest)
    throw Unsupported("the scene has " + std::to_string(system.springs.size()) +
                      " springs, hybrid numbers at most " + std::to_string(largest));
  NodeOrder order = node_order(system);
  scene_node = std::move(order.scene_node);
  for (std::uint32_t i = 0; i < scene_node.size(); ++i) place[scene_node[i]] = i;
  scene_node.resize((scene_node.size() + slice_nodes - 1) / slice_nodes * slice_nodes, no_node);

  const std::vector<Unit> springs = sorted_units(system, place, order.rank);
  std::vector<std::uint32_t> added(places(), 0), received(places(), 0);
  for (const Unit& spring : springs) {
    ++added[spring.first];
    ++received[spring.second];
  }
  const std::vector<std::uint32_t> first_added = beginnings(added), first_received = beginnings(received);
  std::vector<std::uint32_t> force(springs.size()), filled = first_received;  // force: by second end
  first_entry.push_back(0);
  for (std::uint32_t slice = 0; slice < places() / slice_nodes; ++slice) {
    const std::uint32_t* begin = first_added.data() + slice * slice_nodes;
    std::array<std::uint32_t, slice_nodes> next{};
    std::copy_n(begin, slice_nodes, next.begin());
    while (true) {
      // The kinds in turn, each until no node of the slice has one left.
      std::uint32_t kind = std::numeric_limits<std::uint32_t>::max();
      for (std::size_t i = 0; i < slice_nodes; ++i)
        if (next[i] < begin[i + 1]) kind = std::min(kind, springs[next[i]].kind);
      if (kind == std::numeric_limits<std::uint32_t>::max()) break;
      std::array<std::uint32_t, 2 * slice_nodes> entry{};
      for (std::uint32_t i = 0; i < slice_nodes; ++i) {
        const bool has = next[i] < begin[i + 1] && springs[next[i]].kind == kind;
        entry[i] = has ? springs[next[i]].second : slice * static_cast<std::uint32_t>(slice_nodes) + i;
        entry[slice_nodes + i] =
            std::bit_cast<std::uint32_t>(has ? springs[next[i]].rest_length : empty_unit);
        if (!has) continue;
        force[filled[entry[i]]++] = static_cast<std::uint32_t>(unit_count() + force_place(i));
        ++next[i];
      }
      entries.push_back({slice, kind});
      units.insert(units.end(), entry.begin(), entry.end());
    }
    first_entry.push_back(static_cast<std::uint32_t>(entries.size()));
  }

  for (std::size_t node = 0; node < places(); node += list_nodes) {
    first_subtracted.push_back(static_cast<std::uint32_t>(subtracted.size() / list_nodes));
    const std::uint32_t most = *std::max_element(&received[node], &received[node] + list_nodes);
    for (std::uint32_t i = 0; i < most; ++i)
      for (std::size_t of = node; of < node + list_nodes; ++of)
        subtracted.push_back(i < received[of] ? force[first_received[of] + i] : no_force());
  }
  first_subtracted.push_back(static_cast<std::uint32_t>(subtracted.size() / list_nodes));
}

}  // namespace mssim
