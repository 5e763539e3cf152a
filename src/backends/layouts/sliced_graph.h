#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "backends/layouts/node_arrays.h"
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
  std::vector<SpringConstants<float>> constants;  ///< [slots] divided by mass, of all springs of the node
  std::vector<std::uint32_t> held;  ///< [slots] 1 where nothing may move: pinned, or no node; else 0

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

/// What entries of slices count records in, in floats: a processor's address can have such a factor.
inline constexpr std::size_t slice_offset_floats = 2;

/// Throws Unsupported where bodies have more nodes than entries can name records of so many floats.
void require_nameable_records(const System& system, std::size_t floats_of_record);

/// [entries][2][lanes] in one stream: where the neighbours' records start, in units of slice_offset_floats
/// and as std::uint32_t, then SlicedGraph::stiffness_rest. Behind them one that names the first record only,
/// for code that loads records an entry ahead. record_of(slot): the number of a slot's record.
template <class RecordOf>
AlignedArray slice_entries(const SlicedGraph& graph, std::size_t floats_of_record, RecordOf record_of) {
  const std::size_t lanes = graph.lanes;
  AlignedArray entries((graph.entries() + 1) * 2 * lanes);
  for (std::size_t entry = 0; entry < graph.entries(); ++entry)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      float* row = entries.data() + entry * 2 * lanes;
      const std::size_t element = entry * lanes + lane;
      row[lane] = std::bit_cast<float>(static_cast<std::uint32_t>(record_of(graph.neighbour[element]) *
                                                                  (floats_of_record / slice_offset_floats)));
      row[lanes + lane] = graph.stiffness_rest[element];
    }
  return entries;
}

/// What the slices before `slice` cost, in entries: a slice has its own cost beside theirs.
inline std::size_t cost_of_slices_before(const std::vector<std::uint32_t>& first_entry, std::size_t slice) {
  constexpr std::size_t slice_cost = 4;
  return first_entry[slice] + slice * slice_cost;
}

}  // namespace mssim
