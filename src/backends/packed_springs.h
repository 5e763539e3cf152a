#pragma once

#include <array>
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
/// other. A unit's first end is the lower one, and the units are sorted by kind, then by their first and
/// second end: what a node adds then lies in a row, and what it subtracts was added by nodes shortly before.
/// They are laid out as kernels/packed_springs.cl reads them.
struct PackedSprings {
  static constexpr std::size_t side_by_side = 16;  ///< units, of one kind
  static constexpr std::size_t slice_nodes = 4;
  static constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();

  std::vector<std::uint32_t> scene_node;  ///< [places] the scene's number of the node, or no_node at the end
  std::vector<std::uint32_t> place;       ///< [nodes] where the scene's node stands

  /// [units / 16][first node, second node, rest length][16]: places, and the bits of a float, m. What fills
  /// up a kind's last sixteen are units from node 0 to itself, whose forces are not numbers; nobody reads
  /// them.
  std::vector<std::uint32_t> units;
  std::vector<std::uint32_t> kinds;  ///< [units / 16] index into System::materials

  /// [slices][added, subtracted], then the number of entries: where the entries of a slice begin.
  std::vector<std::uint32_t> first_entry;
  /// [entries][slice_nodes] units whose force on a node is to be added, since it is their first end, then
  /// units whose force is to be subtracted. Nodes with fewer than others of their slice get the unit
  /// `unit_count()`, whose force is to be zero.
  std::vector<std::uint32_t> entries;

  /// Throws Unsupported for more springs than 32 bits number from both ends.
  explicit PackedSprings(const System& system);

  std::size_t slices() const { return places() / slice_nodes; }
  std::size_t places() const { return scene_node.size(); }
  std::size_t unit_count() const { return kinds.size() * side_by_side; }

 private:
  /// Fills first_entry and entries from the units. `forces`: [places] how many a node adds and subtracts.
  void list_entries(std::vector<std::array<std::uint32_t, 2>> forces);
};

}  // namespace mssim
