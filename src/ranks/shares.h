#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "backends/layouts/sliced_graph.h"
#include "model/system.h"
#include "text/text.h"

namespace mssim {

/// Why a run on several processes cannot continue; what() is a sentence that names other ranks with their
/// hosts, and calls this one "it".
struct RankFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Assigns items to ranks by weight: the heaviest first, each to the rank with the lowest load (Graham 1969,
/// LPT), which gives the most loaded rank at most 4/3 of the optimum. Returns [items] the rank of each.
inline std::vector<int> ranks_by_weight(const std::vector<std::size_t>& weights, int ranks) {
  std::vector<std::size_t> load(static_cast<std::size_t>(ranks), 0);
  std::vector<int> rank_of(weights.size());
  for (const std::size_t i : ordered_places<std::greater<>>(weights)) {
    const auto least = std::ranges::min_element(load);
    *least += weights[i];
    rank_of[i] = static_cast<int>(least - load.begin());
  }
  return rank_of;
}

/// One rank's share of a body.
struct BodyShare {
  int rank = 0;
  std::size_t nodes = 0;  ///< approximate number of nodes of a divided body

  bool operator==(const BodyShare&) const = default;
};

/// A rank gets at least this many nodes of a divided body; with fewer, nearly all would have remote
/// neighbours.
inline constexpr std::size_t least_share = 16;

/// How far a rank may be above the mean load before a body is divided, relative to the mean.
inline constexpr double most_excess = 0.1;

/// Assigns bodies of these numbers of nodes to ranks: [bodies] the ranks of each, one if it stays whole. All
/// bodies stay whole if every rank then has one and none is more than most_excess above the mean. Otherwise
/// as few of the largest bodies as necessary are divided, and fill the ranks up to one level on top of the
/// whole ones. Every rank has nodes; nothing if that is impossible, because bodies that are too small would
/// have to be divided.
std::optional<std::vector<std::vector<BodyShare>>> body_shares(const std::vector<std::size_t>& nodes,
                                                               int ranks);

/// The largest number of ranks, at most `ranks`, to which these bodies can be assigned.
int most_ranks(const std::vector<std::size_t>& nodes, int ranks);

/// Cuts nodes joined by springs into parts, along few springs (METIS's k-way partition; G. Karypis and V.
/// Kumar, 1998). `shares`: [parts] the relative size of each; there must be as many nodes as parts. The sizes
/// are met to a few per cent, with nodes weighted by the cost of a step. Returns [nodes] the part of each; no
/// part is empty. Deterministic. Throws RankFailure if METIS fails.
std::vector<std::uint32_t> graph_partition(std::size_t nodes, std::span<const Spring> springs,
                                           std::span<const std::size_t> shares);

/// The nodes of bodies that one rank steps, and its ghosts: nodes of other ranks that springs join to them.
struct BodiesPart {
  /// Another rank with neighbours of this rank's nodes.
  struct Neighbour {
    int rank;
    std::vector<std::uint32_t> edge;  ///< own nodes that are ghosts there, in the order of its ghosts
    std::size_t ghosts;               ///< number of its nodes that are ghosts here
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
