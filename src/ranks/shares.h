#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "backends/layouts/sliced_graph.h"
#include "model/system.h"

namespace mssim {

/// Why this run over several processes cannot go on; what() is a sentence that
/// names other ranks with their hosts, and calls this one "it".
struct RankFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Gives things of these weights to so many ranks: the heaviest first, each to the rank with the least so far
/// (Graham 1969, LPT), which is at most 4/3 of what the best way gives the rank with most. [things] the rank
/// of each.
inline std::vector<int> ranks_by_weight(const std::vector<std::size_t>& weights, int ranks) {
  std::vector<std::size_t> order(weights.size()), load(static_cast<std::size_t>(ranks), 0);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return weights[i]; });
  std::vector<int> rank_of(weights.size());
  for (const std::size_t i : order) {
    const auto least = std::ranges::min_element(load);
    *least += weights[i];
    rank_of[i] = static_cast<int>(least - load.begin());
  }
  return rank_of;
}

/// What one rank steps of a body.
struct BodyShare {
  int rank = 0;
  std::size_t nodes = 0;  ///< of a divided body: about so many

  bool operator==(const BodyShare&) const = default;
};

/// A divided body gives no rank fewer nodes: nearly all of them would have neighbours elsewhere.
inline constexpr std::size_t least_share = 16;

/// How far a rank may be above the mean of all before a body is divided: as a part of the mean.
inline constexpr double most_excess = 0.1;

/// Gives bodies of so many nodes to ranks: [bodies] the ranks of each, one where it stays whole. Whole bodies
/// where all ranks then have one and none has more than most_excess above the mean. Else the largest bodies
/// are divided, as few as that takes, and fill the ranks up to one level on top of the whole ones. Every rank
/// has something; nothing where that cannot be, because bodies that are too small would have to be divided.
std::optional<std::vector<std::vector<BodyShare>>> body_shares(const std::vector<std::size_t>& nodes,
                                                               int ranks);

/// The largest number of ranks, at most `ranks`, that these bodies can be given to.
int most_ranks(const std::vector<std::size_t>& nodes, int ranks);

/// Cuts nodes that springs join into parts, along few springs (METIS's k-way partition; G. Karypis and V.
/// Kumar, 1998). `shares`: [parts] how much of the nodes each is to have, in any unit; there must be as many
/// nodes as parts. The parts differ from that by a few per cent. A node counts as much as stepping it costs.
/// [nodes] the part of each; no part is empty. The same graph always gives the same parts. Throws RankFailure
/// where METIS fails.
std::vector<std::uint32_t> graph_partition(std::size_t nodes, std::span<const Spring> springs,
                                           std::span<const std::size_t> shares);

/// The nodes of bodies that one rank steps, and those of other ranks that springs join to them: its ghosts.
struct BodiesPart {
  /// Another rank that has neighbours of nodes of this one.
  struct Neighbour {
    int rank;
    std::vector<std::uint32_t> edge;  ///< own nodes that are ghosts there, in the order of its ghosts
    std::size_t ghosts;               ///< nodes of it that are ghosts here
  };

  /// Own nodes in the order of the bodies, then the ghosts of each neighbour in the same order. It has the
  /// springs with an own end, and no topology.
  System system;
  GraphPart graph;
  std::vector<Neighbour> neighbours;  ///< ascending by rank
};

/// The part of a rank in these bodies. `place`: [nodes] of the bodies in the order of the scene (GraphPart);
/// `owner`: [nodes] the rank of each.
BodiesPart part_of_bodies(const System& bodies, std::span<const std::uint32_t> place,
                          std::span<const int> owner, int rank);

}  // namespace mssim
