#include "ranks/shares.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace mssim {
namespace {

using Shares = std::vector<std::vector<BodyShare>>;

/// The level up to which `nodes` nodes fill ranks with these loads.
double level_of(std::vector<std::size_t> loads, std::size_t nodes) {
  std::ranges::sort(loads);
  auto below = static_cast<double>(nodes);  // nodes of the lowest ranks, including those to be filled in
  for (std::size_t lowest = 1;; ++lowest) {
    below += static_cast<double>(loads[lowest - 1]);
    const double level = below / static_cast<double>(lowest);
    if (lowest == loads.size() || level <= static_cast<double>(loads[lowest])) return level;
  }
}

/// Assigns bodies to ranks, one after the other.
class Filling {
 public:
  Filling(std::size_t bodies, int ranks) : shares(bodies), loads(static_cast<std::size_t>(ranks), 0) {}

  void give(std::size_t body, std::size_t rank, std::size_t nodes) {
    shares[body].push_back({static_cast<int>(rank), nodes});
    loads[rank] += nodes;
  }
  /// Assigns whole bodies, the heaviest first.
  void give_whole(const std::vector<std::size_t>& bodies, const std::vector<std::size_t>& nodes) {
    const auto weights = mapped<std::size_t>(bodies, [&](std::size_t body) { return nodes[body]; });
    const std::vector<int> rank_of = ranks_by_weight(weights, static_cast<int>(loads.size()));
    for (std::size_t i = 0; i < bodies.size(); ++i)
      give(bodies[i], static_cast<std::size_t>(rank_of[i]), weights[i]);
  }
  /// Fills the ranks up to one level, those with most room first: a body continues in the next rank when one
  /// is full. No part is too small, so one on an idle rank may rise above the level.
  void divide(const std::vector<std::size_t>& bodies, const std::vector<std::size_t>& nodes) {
    std::size_t together = 0;
    for (const std::size_t body : bodies) together += nodes[body];
    const double level = level_of(loads, together);
    const std::vector<std::size_t> order = ordered_places(loads);
    auto rank = order.begin();
    double missing = 0;  // nodes by which earlier ranks are below the level, mostly because of rounding
    const auto room = [&] { return level - static_cast<double>(loads[*rank]); };
    const auto leave = [&] {
      missing += room();
      ++rank;
    };
    for (const std::size_t body : bodies)
      for (std::size_t rest = nodes[body]; rest > 0;) {
        const std::size_t least = std::min(rest, least_share);
        while (rank != order.end() && loads[*rank] > 0 && room() < static_cast<double>(least)) leave();
        if (rank == order.end()) {
          give_rest(body, rest);
          break;
        }
        const auto wanted = static_cast<std::size_t>(std::max(0L, std::lround(room() + missing)));
        std::size_t part = std::clamp(wanted, least, rest);
        if (rest - part < least_share) part = rest;
        give(body, *rank, part);
        rest -= part;
        if (rest > 0) leave();
      }
  }
  std::size_t most() const { return std::ranges::max(loads); }
  bool has_idle_rank() const { return std::ranges::min(loads) == 0; }

  Shares shares;                   ///< [bodies]
  std::vector<std::size_t> loads;  ///< [ranks] nodes

 private:
  /// Gives the rest of a body to the rank with the lowest load, which may already have a part of it.
  void give_rest(std::size_t body, std::size_t nodes) {
    const auto rank = static_cast<std::size_t>(std::ranges::min_element(loads) - loads.begin());
    const auto same = std::ranges::find(shares[body], static_cast<int>(rank), &BodyShare::rank);
    if (same == shares[body].end()) return give(body, rank, nodes);
    same->nodes += nodes;
    loads[rank] += nodes;
  }
};

/// A node and the rank that needs it.
using RankAndNode = std::pair<int, std::uint32_t>;

/// Sorted, without duplicates.
std::vector<RankAndNode> in_order(std::vector<RankAndNode> nodes) {
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace

std::optional<Shares> body_shares(const std::vector<std::size_t>& nodes, int ranks) {
  const std::vector<std::size_t> order = ordered_places<std::greater<>>(nodes);
  const auto all = static_cast<double>(std::reduce(nodes.begin(), nodes.end()));
  const double most_allowed = (1 + most_excess) * all / ranks;
  std::optional<Filling> best;
  // More divided bodies than ranks are never needed: together they weigh as much as the largest whole body on
  // every rank, and so fill the gaps that the whole ones leave.
  const std::size_t most_divided = std::min(nodes.size(), static_cast<std::size_t>(ranks));
  for (std::size_t divided = 0; divided <= most_divided; ++divided) {
    const auto first_whole = order.begin() + static_cast<std::ptrdiff_t>(divided);
    Filling filling(nodes.size(), ranks);
    filling.give_whole({first_whole, order.end()}, nodes);
    filling.divide({order.begin(), first_whole}, nodes);
    if (filling.has_idle_rank()) continue;
    if (!best || filling.most() < best->most()) best = filling;
    if (static_cast<double>(best->most()) <= most_allowed) break;
  }
  if (!best) return std::nullopt;
  return best->shares;
}

int most_ranks(const std::vector<std::size_t>& nodes, int ranks) {
  std::size_t parts = 0;
  for (const std::size_t body : nodes) parts += std::max<std::size_t>(1, body / least_share);
  ranks = static_cast<int>(std::min(static_cast<std::size_t>(ranks), parts));
  while (ranks > 1 && !body_shares(nodes, ranks)) --ranks;
  return ranks;
}

BodiesPart part_of_bodies(const System& bodies, std::span<const std::uint32_t> place,
                          std::span<const int> owner, int rank) {
  std::vector<RankAndNode> edge, ghosts;
  for (const Spring& spring : bodies.springs)
    for (const auto& [node, other] : {std::pair{spring.first, spring.second}, {spring.second, spring.first}})
      if (owner[node] == rank && owner[other] != rank) {
        edge.emplace_back(owner[other], node);
        ghosts.emplace_back(owner[other], other);
      }
  edge = in_order(std::move(edge));
  ghosts = in_order(std::move(ghosts));

  constexpr std::uint32_t elsewhere = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(bodies.nodes(), elsewhere);  // [nodes] number in the part
  BodiesPart part;
  System& system = part.system = with_laws_of(bodies);
  const auto add = [&](std::uint32_t node) {
    number[node] = static_cast<std::uint32_t>(system.nodes());
    system.start.add(bodies.start.position[node], bodies.start.velocity[node]);
    system.node_mass.push_back(bodies.node_mass[node]);
    part.graph.place.push_back(place[node]);
  };
  for (std::uint32_t node = 0; node < bodies.nodes(); ++node)
    if (owner[node] == rank) add(node);
  part.graph.own = system.nodes();
  for (const auto& [other_rank, node] : ghosts) {
    add(node);
    if (part.neighbours.empty() || part.neighbours.back().rank != other_rank)
      part.neighbours.push_back({other_rank, {}, 0});
    ++part.neighbours.back().ghosts;
  }
  // Every rank with a ghost here has an adjacent own node.
  auto neighbour = part.neighbours.begin();
  for (const auto& [other_rank, node] : edge) {
    while (neighbour->rank != other_rank) ++neighbour;
    neighbour->edge.push_back(number[node]);
  }
  for (Spring spring : bodies.springs) {
    if (owner[spring.first] != rank && owner[spring.second] != rank) continue;
    spring.first = number[spring.first];
    spring.second = number[spring.second];
    system.springs.push_back(spring);
  }
  for (const std::uint32_t pin : bodies.pins)
    if (owner[pin] == rank) system.pins.push_back(number[pin]);
  return part;
}

}  // namespace mssim
