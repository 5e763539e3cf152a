#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "model/system.h"

namespace mssim {

/// The springs of a system as `hybrid` shares them between device and host: units of which the device
/// computes one force each, and for every node the forces that the host sums.
///
/// The nodes are numbered for it: a grid's as they are, those of bodies so that neighbours stand near each
/// other. The units are sorted by kind, then by their first node, and laid out as kernels/packed_springs.cl
/// reads them.
struct PackedSprings {
  static constexpr std::size_t side_by_side = 16;  ///< units, of one kind
  static constexpr std::size_t slice_nodes = 4;
  static constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();
  /// Set in an entry whose node is the unit's second end and feels the opposite of its force.
  static constexpr std::uint32_t opposite = 0x80000000;

  std::vector<std::uint32_t> scene_node;  ///< [places] the scene's number of the node, or no_node at the end
  std::vector<std::uint32_t> place;       ///< [nodes] where the scene's node stands

  /// [units / 16][first node, second node, rest length][16]: places, and the bits of a float, m. What fills
  /// up a kind's last sixteen are units from node 0 to itself, whose forces are not numbers; nobody reads
  /// them.
  std::vector<std::uint32_t> units;
  std::vector<std::uint32_t> kinds;  ///< [units / 16] index into System::materials

  /// [slices + 1] of the slice; the last one is the number of entries.
  std::vector<std::uint32_t> first_entry;
  /// [entries][slice_nodes] a unit, perhaps `opposite`. Nodes with fewer springs than others of their slice
  /// end with the unit `unit_count()`, whose force is to be zero.
  std::vector<std::uint32_t> entries;

  /// Throws Unsupported for more springs than 31 bits number.
  explicit PackedSprings(const System& system);

  std::size_t places() const { return scene_node.size(); }
  std::size_t unit_count() const { return kinds.size() * side_by_side; }
};

}  // namespace mssim
