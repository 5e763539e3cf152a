#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "backends/layouts/sliced_graph.h"
#include "model/system.h"

namespace mssim {

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
