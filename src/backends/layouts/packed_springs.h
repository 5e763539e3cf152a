#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "backends/layouts/alike_bodies.h"
#include "backends/layouts/grouped.h"
#include "model/system.h"

namespace mssim {

/// The springs of a system as `hybrid` shares them between device and host: units, for each of which the
/// device computes one force, and for every node the forces that the host sums.
///
/// A unit is what Hong et al., Figure 6, pack for each spring: [i, j, rest length]. Nodes are in slices of
/// sixteen, and an entry is sixteen units of one kind; the first end of each is the slice's node of the same
/// number. So the device loads the first ends of a slice once for all its entries, and the host adds the
/// forces on a slice's nodes as first ends without any index. For second ends it uses a list.
///
/// The nodes are renumbered: a grid's keep their order, those of bodies are ordered so that neighbours are
/// near each other (reverse Cuthill-McKee), then sorted within windows by the number of forces that they add
/// and subtract. Except for the sorting, a first end comes before the second one in that order, so a force is
/// subtracted shortly after it was added.
struct PackedSprings {
  static constexpr std::size_t slice_nodes = 16;
  static constexpr std::size_t list_nodes = 4;
  static constexpr std::size_t window = 512;  ///< nodes; sorted by their forces
  static constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();
  static constexpr float empty_unit = -1;

  std::vector<std::uint32_t> scene_node;  ///< [slots] the scene's node number, or no_node at the end
  std::vector<std::uint32_t> slot;        ///< [nodes] slot of the scene's node

  std::vector<std::uint32_t> first_entry;  ///< [slices + 1]; the last one is the number of entries
  /// Data that the units of an entry share.
  struct Entry {
    std::uint32_t slice;
    std::uint32_t kind;  // index into System::materials
  };
  std::vector<Entry> entries;
  /// [entries][second node, rest length][16]: slots, and the bits of a float, m. If a node has fewer units
  /// than its slice has entries, the rest name the node itself and empty_unit: such a unit must give no
  /// force.
  std::vector<std::uint32_t> units;

  /// [slots / 4 + 1]: begin of the list of each four nodes, and the end of the last list.
  std::vector<std::uint32_t> first_subtracted;
  /// [..][4], interleaved for four nodes: index of a force to be subtracted, because the node is the second
  /// end. If a node has fewer than the others of its four, its list ends with no_force().
  std::vector<std::uint32_t> subtracted;

  /// Throws Unsupported if there are too many springs for 32-bit indices.
  explicit PackedSprings(const System& system);

  std::size_t slots() const { return scene_node.size(); }  ///< slices() * slice_nodes
  std::size_t slices() const { return first_entry.size() - 1; }
  std::size_t unit_count() const { return entries.size() * slice_nodes; }

  /// Forces are stored by entries, sixteen (x, y, z, 0) each; this is a slot's position among the sixteen.
  /// Nodes 0, 4, 8 and 12 first, then 1, 5 and so on: transpositions within each four elements, from
  /// components to forces on the device and back on the host, give this order.
  static constexpr std::size_t force_place(std::size_t node) { return node % 4 * 4 + node / 4; }
  /// Index of a zero force: after all others.
  std::uint32_t no_force() const { return static_cast<std::uint32_t>(unit_count()); }

 private:
  /// Fills entries and units. `rank`: [nodes] position of each of the scene's nodes.
  void pack_units(const System& system, const std::vector<std::uint32_t>& rank);
  /// Fills the lists of subtracted forces from the units.
  void list_subtracted();
};

/// The springs of alike bodies as `hybrid` shares them between device and host, instead of PackedSprings: the
/// device computes the forces of a spring for sixteen bodies together (kernels/alike_springs.cl), and the
/// host sums whole vectors of forces for every slice. Constants are divided by a node's mass, so forces are
/// accelerations.
struct AlikeSprings {
  static constexpr std::size_t slice_nodes = 16;

  /// A spring of one group of bodies.
  struct SpringOfSlices {
    std::uint32_t first, second;  ///< slices
    float stiffness_rest;         ///< AlikeBodies::SpringAhead::stiffness_rest
    std::uint32_t shape;
  };

  AlikeSlices slices;
  std::vector<SpringConstants<float>> shapes;  ///< AlikeBodies::constants
  std::vector<std::uint8_t> pinned;            ///< [slices] 1 if pinned, else 0
  std::vector<SpringOfSlices> springs;         ///< sorted by first, then by second slice
  std::vector<std::uint32_t> first_end;        ///< [slices + 1] begin of a slice's springs in `springs`
  Grouped<std::uint32_t> subtracted;           ///< by slice: the springs that end there, ascending

  /// Throws Unsupported if there are too many springs per lane for 32-bit indices.
  explicit AlikeSprings(const std::vector<AlikeBodies>& bodies);
};

}  // namespace mssim
