#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "model/system.h"

namespace mssim {

/// What a system that is a part of another one (the whole) must know of that, so that its steps have the same
/// bits.
struct GraphPart {
  /// [nodes] where the node stands in the whole's reverse_cuthill_mckee(): a node's springs are added in this
  /// order of its neighbours.
  std::vector<std::uint32_t> place;
  /// Nodes from this one on are ghosts: neighbours of the part's own nodes that are stepped elsewhere.
  std::size_t own = 0;
};

/// The springs of a system as every node sees them, for code that gathers: the nodes renumbered so that
/// neighbours stand near each other (reverse Cuthill-McKee), then sorted by degree within windows, then cut
/// into slices of `lanes` nodes, whose springs lie side by side (sliced ELLPACK; M. Kreutzer et al., 2014,
/// call it SELL-C-sigma). The spring law's constants are divided by the mass of the node, so that forces are
/// accelerations.
///
/// A slice has as many entries as its node of the largest degree, its neighbours in the order before windows
/// were sorted; entry e of the slice gives each lane's node one neighbour, in elements e * lanes + lane of
/// `neighbour` and `stiffness_rest`. Nodes of smaller degree end with empty entries: the node itself for a
/// neighbour, and empty_entry, which is negative as no spring's is, for stiffness_rest. They must give no
/// force: their length is 0, so that any finite pull gives none.
///
/// Places after the last node fill up the last slice: held, with empty entries only.
///
/// A graph may be a part of that of a whole: then its nodes that are neighbours of ghosts (edge nodes) lie in
/// slices of their own after the others, and the ghosts, which no slice has, behind them.
struct SlicedGraph {
  static constexpr std::size_t window = 256;  ///< nodes; more saves few empty entries and costs locality
  static constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();
  static constexpr float empty_entry = -1;

  std::size_t lanes = 0;                  ///< nodes in a slice
  std::vector<std::uint32_t> scene_node;  ///< [slots] the scene's number of the node, or no_node
  /// [nodes] where the scene's node stands; of a part, ghost g stands at slots() + g.
  std::vector<std::uint32_t> slot;
  std::size_t ghosts = 0;            ///< nodes that no slice has
  std::size_t first_edge_slice = 0;  ///< slices from here on have edge nodes; slices() where there are none
  std::vector<std::uint32_t>
      first_entry;                       ///< [slices + 1] of the slice; the last one is the number of entries
  std::vector<std::uint32_t> neighbour;  ///< [entries][lanes] slots
  std::vector<float> stiffness_rest;     ///< [entries][lanes] stiffness * rest length / mass, m/s^2
  std::vector<float> stiffness;          ///< [slots] 1/s^2, of all springs of the node
  std::vector<float> damping;            ///< [slots] 1/s
  std::vector<std::uint32_t> held;       ///< [slots] 1 where nothing may move: pinned, or no node; else 0

  /// Throws Unsupported where springs of unlike materials meet in a node, and for more springs than 32 bits
  /// number from both ends.
  SlicedGraph(const System& system, std::size_t slice_lanes);
  /// Slices a part of a graph: its nodes have the entries of the whole's graph, in the same order, with the
  /// same constants. Springs between ghosts are left out.
  SlicedGraph(const System& system, std::size_t slice_lanes, const GraphPart& part);

  std::size_t nodes() const { return slot.size(); }
  std::size_t slots() const { return scene_node.size(); }  ///< slices() * lanes
  std::size_t slices() const { return first_entry.size() - 1; }
  std::size_t entries() const { return first_entry.back(); }
};

}  // namespace mssim
