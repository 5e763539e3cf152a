#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "backends/layouts/alike_bodies.h"
#include "model/system.h"

namespace mssim {

/// The springs of a system as `hybrid` shares them between device and host: units of which the device
/// computes one force each, and for every node the forces that the host sums.
///
/// A unit is what Hong et al., Figure 6, pack for each spring: [i, j, rest length]. Nodes stand in slices of
/// sixteen, and an entry is sixteen units of one kind side by side, the first end of each being the slice's
/// node of the same number. So the device loads the first ends of a slice once for all its entries, and the
/// host adds what a slice's nodes have as first ends without looking anything up. What the nodes have as
/// second ends it finds by a list.
///
/// The nodes are numbered for it: a grid's as they are, those of bodies so that neighbours stand near each
/// other (reverse Cuthill-McKee), sorted within windows by how many forces they add and subtract. A first end
/// comes before the second one in that order, up to the sorting: what a node subtracts was added shortly
/// before.
struct PackedSprings {
  static constexpr std::size_t slice_nodes = 16;
  static constexpr std::size_t list_nodes = 4;
  static constexpr std::size_t window = 512;  ///< nodes, sorted by their forces
  static constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();
  static constexpr float empty_unit = -1;

  std::vector<std::uint32_t> scene_node;  ///< [slots] the scene's number of the node, or no_node at the end
  std::vector<std::uint32_t> slot;        ///< [nodes] where the scene's node stands

  std::vector<std::uint32_t> first_entry;  ///< [slices + 1], the last one is the number of entries
  /// What the units of an entry share.
  struct Entry {
    std::uint32_t slice;
    std::uint32_t kind;  // index into System::materials
  };
  std::vector<Entry> entries;
  /// [entries][second node, rest length][16]: slots, and the bits of a float, m. Where a node has fewer
  /// units than its slice has entries, the node itself and empty_unit: such a unit must give no force.
  std::vector<std::uint32_t> units;

  /// [slots / 4 + 1]: where the list of each four nodes begins, and the end of the last one.
  std::vector<std::uint32_t> first_subtracted;
  /// [..][4] in turn for each of four nodes: where a force lies that is to be subtracted, since the node is
  /// the second end. The list of a node with fewer than the others of its four ends with no_force().
  std::vector<std::uint32_t> subtracted;

  /// Throws Unsupported for more springs than 32 bits number.
  explicit PackedSprings(const System& system);

  std::size_t slots() const { return scene_node.size(); }  ///< slices() * slice_nodes
  std::size_t slices() const { return first_entry.size() - 1; }
  std::size_t unit_count() const { return entries.size() * slice_nodes; }

  /// Forces lie by entries, sixteen after each other, as (x, y, z, 0) each; this is the slot among the
  /// sixteen. Nodes 0, 4, 8 and 12 first, then 1, 5 and so on: that is where transpositions of vectors within
  /// each four elements put them, from components to forces on the device and back on the host.
  static constexpr std::size_t force_place(std::size_t node) { return node % 4 * 4 + node / 4; }
  /// Where a force of zero is to lie: behind all others.
  std::uint32_t no_force() const { return static_cast<std::uint32_t>(unit_count()); }

 private:
  /// Fills entries and units. `rank`: [nodes] how far ahead each of the scene's nodes is.
  void pack_units(const System& system, const std::vector<std::uint32_t>& rank);
  /// Fills the lists of what is subtracted from the units.
  void list_subtracted();
};

/// The springs of alike bodies as `hybrid` shares them between device and host, in place of PackedSprings:
/// the device computes the forces of a spring of sixteen bodies side by side (kernels/alike_springs.cl), and
/// the host sums for every slice whole vectors of forces. Constants are divided by a node's mass, so that
/// forces are accelerations.
struct AlikeSprings {
  static constexpr std::size_t slice_nodes = 16;

  /// The springs of one group of bodies.
  struct SpringOfSlices {
    std::uint32_t first, second;  ///< slices
    float stiffness_rest;         ///< AlikeBodies::SpringAhead::stiffness_rest
    std::uint32_t shape;
  };

  AlikeSlices slices;
  std::vector<SpringConstants<float>> shapes;  ///< AlikeBodies::constants
  std::vector<std::uint8_t> pinned;            ///< [slices] 1 where nodes are, else 0
  std::vector<SpringOfSlices> springs;         ///< ascending by first, then by second slice
  std::vector<std::uint32_t>
      first_end;  ///< [slices + 1] where in `springs` those begin that begin at a slice
  /// [slices + 1] where in `subtracted` the springs of a slice begin, which are the springs that end there.
  std::vector<std::uint32_t> first_subtracted;
  std::vector<std::uint32_t> subtracted;  ///< [springs] ascending within a slice

  /// Throws Unsupported for more springs than 32 bits number for each lane.
  explicit AlikeSprings(const std::vector<AlikeBodies>& bodies);
};

}  // namespace mssim
