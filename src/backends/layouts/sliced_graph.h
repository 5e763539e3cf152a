#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#include "backends/layouts/node_arrays.h"
#include "model/system.h"

namespace mssim {

/// Data of the whole system that a part of it needs for bitwise identical steps.
struct GraphPart {
  /// [nodes] position in the whole's reverse_cuthill_mckee(): a node's springs are added in this order of its
  /// neighbours.
  std::vector<std::uint32_t> place;
  /// Nodes from this one on are ghosts: neighbours of own nodes that other processes step.
  std::size_t own = 0;
};

/// The springs of a system as every node sees them, for code that gathers: the nodes are renumbered so that
/// neighbours are near each other (reverse Cuthill-McKee), then sorted by degree within windows, then divided
/// into slices of `lanes` nodes, whose springs are interleaved (sliced ELLPACK; M. Kreutzer et al., 2014,
/// call it SELL-C-sigma). The spring law's constants are divided by the mass of the node, so forces are
/// accelerations.
///
/// A slice has as many entries as the largest degree of its nodes; a node's neighbours are in the order
/// before sorting. Entry e of the slice gives each lane's node one neighbour, in elements e * lanes + lane of
/// `neighbour` and `stiffness_rest`. Nodes of smaller degree end with empty entries: the node itself as its
/// neighbour, and empty_entry, which unlike a spring's is negative, as stiffness_rest. They must give no
/// force: their length is 0, so any finite pull gives none.
///
/// Slots after the last node fill up the last slice: held, with only empty entries.
///
/// A graph may be a part of a whole: then its nodes with ghost neighbours (edge nodes) are in slices of their
/// own after the others, and the ghosts, which are in no slice, come after them.
template <class Real>
struct SlicedGraphOf {
  static constexpr std::size_t window = 256;  ///< nodes; more saves few empty entries and costs locality
  static constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();
  static constexpr Real empty_entry = -1;

  std::size_t lanes = 0;                  ///< nodes per slice
  std::vector<std::uint32_t> scene_node;  ///< [slots] the scene's node number, or no_node
  /// [nodes] slot of the scene's node; in a part, the slot of ghost g is slots() + g.
  std::vector<std::uint32_t> slot;
  std::size_t ghosts = 0;            ///< nodes in no slice
  std::size_t first_edge_slice = 0;  ///< slices from here on have edge nodes; slices() if there are none
  std::vector<std::uint32_t> first_entry;        ///< [slices + 1] the last one is the number of entries
  std::vector<std::uint32_t> neighbour;          ///< [entries][lanes] slots
  std::vector<Real> stiffness_rest;              ///< [entries][lanes] stiffness * rest length / mass, m/s^2
  std::vector<SpringConstants<Real>> constants;  ///< [slots] divided by mass, of all springs of the node
  std::vector<std::uint32_t> held;               ///< [slots] 1 if pinned or padding, else 0

  /// Throws Unsupported if springs of different materials meet in a node, or if there are too many springs
  /// for 32-bit indices from both ends.
  SlicedGraphOf(const System& system, std::size_t slice_lanes);
  /// Slices a part of a graph: its nodes have the same entries as in the whole's graph, in the same order,
  /// with the same constants. Springs between ghosts are omitted.
  SlicedGraphOf(const System& system, std::size_t slice_lanes, const GraphPart& part);

  std::size_t nodes() const { return slot.size(); }
  std::size_t slots() const { return scene_node.size(); }  ///< slices() * lanes
  std::size_t slices() const { return first_entry.size() - 1; }
  std::size_t entries() const { return first_entry.back(); }
};
using SlicedGraph = SlicedGraphOf<float>;

/// Unit of record offsets in slice entries, in numbers: eight bytes, a scale factor that CPU addressing
/// supports.
template <class Real>
inline constexpr std::size_t slice_offset_unit = 8 / sizeof(Real);

/// Throws Unsupported if there are more nodes than entries can address as records of `floats_of_record`
/// numbers.
void require_nameable_records(const System& system, std::size_t floats_of_record);

/// An unsigned number of the size of a Real.
template <class Real>
using BitsOf = std::conditional_t<sizeof(Real) == sizeof(std::uint32_t), std::uint32_t, std::uint64_t>;

/// [entries][2][lanes] in one stream: offsets of the neighbours' records, in units of slice_offset_unit and
/// as BitsOf<Real>, then SlicedGraph::stiffness_rest. An entry that names only the first record follows, for
/// code that loads records one entry ahead. record_of(slot): the number of a slot's record.
template <class Real, class RecordOf>
AlignedArrayOf<Real> slice_entries(const SlicedGraphOf<Real>& graph, std::size_t floats_of_record,
                                   RecordOf record_of) {
  const std::size_t lanes = graph.lanes;
  AlignedArrayOf<Real> entries((graph.entries() + 1) * 2 * lanes);
  for (std::size_t entry = 0; entry < graph.entries(); ++entry)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      Real* row = entries.data() + entry * 2 * lanes;
      const std::size_t element = entry * lanes + lane;
      row[lane] = std::bit_cast<Real>(static_cast<BitsOf<Real>>(
          record_of(graph.neighbour[element]) * (floats_of_record / slice_offset_unit<Real>)));
      row[lanes + lane] = graph.stiffness_rest[element];
    }
  return entries;
}

/// Cost of the slices before `slice`, in entries: a slice has a fixed cost besides its entries.
inline std::size_t cost_of_slices_before(const std::vector<std::uint32_t>& first_entry, std::size_t slice) {
  constexpr std::size_t slice_cost = 4;
  return first_entry[slice] + slice * slice_cost;
}

}  // namespace mssim
