#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/implicit/nodes/node_chunk.h"
#include "backends/interface/backend.h"
#include "backends/layouts/aligned_array.h"
#include "model/system.h"

namespace mssim {

/// Bodies as implicit integrators with vectors see them, in the slices of SlicedGraph; what NodeRows is for
/// cloths. A field is an array of records x y z 0: a vector of neighbours is gathered by loading whole
/// records and transposing them in registers.
struct NodeSlices {
  static constexpr std::size_t record_floats = 4;
  /// Numbers of each node in `constants`.
  enum Constant : std::size_t { stiffness, damping, free, mass, constant_count };

  std::size_t lanes = 0;
  Surroundings surroundings{};
  std::size_t nodes = 0;
  std::vector<std::uint32_t> record;       ///< [nodes] the number of a node's record
  std::vector<std::uint32_t> first_entry;  ///< SlicedGraph::first_entry
  AlignedArray entries;                    ///< slice_entries()
  /// [slices][constant_count][lanes] SlicedGraph's stiffness and damping, 1 where a node moves or else 0, and
  /// mass in kg, 0 where no node is.
  AlignedArray constants;
  std::vector<NodeChunk> chunks;  ///< of slices

  /// Throws Unsupported like SlicedGraph, and for more nodes than entries can name.
  NodeSlices(const System& system, std::size_t lanes);

  std::size_t slices() const { return first_entry.size() - 1; }
  /// Floats of a field. They must be zero where no node is, as they are in a new AlignedArray.
  std::size_t field_floats() const { return slices() * lanes * record_floats; }
  /// What a sum over nodes of SliceVector::weighted() is to be multiplied with, so that weights are masses.
  static constexpr double sum_factor() { return 1; }
  /// Floats of a field of slopes: four of every entry.
  std::size_t slope_floats() const { return first_entry.back() * 4 * lanes; }
  std::size_t vectors() const { return slices(); }
  /// The floats of a field that belong to a chunk's nodes, whole vectors; and zeros beside them.
  NodeChunk floats_of(NodeChunk chunk) const {
    const std::size_t slice_floats = lanes * record_floats;
    return {chunk.begin * slice_floats, chunk.end * slice_floats};
  }
  /// Where the x of a node, by its number in the scene, stands in a field.
  std::size_t offset(std::size_t node) const { return record[node] * record_floats; }
  /// Floats from a component of a node to its next one.
  static constexpr std::size_t component_step() { return 1; }
};

}  // namespace mssim
