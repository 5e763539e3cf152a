#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/layouts/node_arrays.h"
#include "model/system.h"

namespace mssim {

/// Nodes in the layouts of implicit integrators with vectors: NodeRows for a cloth, NodeSlices for bodies.
/// They compute with fields, arrays with a vector in space for each node, zero without a node, as in a new
/// AlignedArray. The vector code (node_vectors-inl.h) walks over the nodes and loads any field at a node or
/// at its neighbours.

/// A chunk is a thread's unit of work, with a partial sum of its own: rows of a cloth or slices of bodies.
/// Chunks, and so the sums over them, depend only on the system: enough to balance the work of one machine's
/// threads, few enough that adding their sums takes no time.
inline constexpr std::size_t most_node_chunks = 256;

/// Divides `count` items into at most most_node_chunks chunks of about equal cost. cost_before(i): total cost
/// of the items before the i-th.
template <class CostBefore>
std::vector<IndexRange> balanced_node_chunks(std::size_t count, CostBefore cost_before) {
  auto chunks = balanced_ranges({0, count}, std::min(count, most_node_chunks), cost_before);
  std::erase_if(chunks, [](const IndexRange& chunk) { return chunk.begin == chunk.end; });
  return chunks;
}

/// A cloth.
struct NodeRows {
  using Layout = RowLayout<3>;  ///< of a field: x y z
  using Plane = RowLayout<1>;   ///< of one number per node

  static constexpr std::size_t spring_slopes = 4;  ///< numbers of a spring in a field of slopes
  /// Layout of a field of slopes: those of the springs of grid_stencil, at the nodes that own them.
  using SlopeLayout = RowLayout<grid_stencil.size() * spring_slopes>;

  Layout layout;
  SlopeLayout slope_layout;
  Plane plane;
  std::vector<SpringPerMass> springs;  ///< [kinds]
  Surroundings surroundings{};
  std::size_t nodes = 0;
  double mass = 0;                        ///< per node, kg
  AlignedArray free;                      ///< [Plane::floats] 1 at nodes that move, 0 at pins and outside
  std::vector<std::uint8_t> row_is_free;  ///< [rows] 1 if no node of the row is pinned
  std::vector<IndexRange> chunks;         ///< of rows

  /// Lays out a cloth. `lanes`: floats of a vector. Throws Unsupported if the nodes differ in mass.
  NodeRows(const System& system, std::size_t lanes);

  /// Floats of a field.
  std::size_t field_floats() const { return layout.floats(); }
  /// Factor for a sum over nodes of RowVector::weighted() that makes the weights masses.
  double sum_factor() const { return mass; }
  /// Floats of a field of slopes.
  std::size_t slope_floats() const { return slope_layout.floats(); }
  std::size_t row_vectors() const { return (layout.columns + layout.lanes - 1) / layout.lanes; }
  std::size_t vectors() const { return layout.rows * row_vectors(); }
  /// The floats of a field for a chunk's nodes, whole vectors, including adjacent zeros.
  IndexRange floats_of(IndexRange chunk) const {
    return {(chunk.begin + Layout::ring) * layout.row_floats(),
            (chunk.end + Layout::ring) * layout.row_floats()};
  }
  /// Offset of the x of a node, by its number in the scene, in a field.
  std::size_t offset(std::size_t node) const { return layout.offset(node); }
  /// Floats from a component of a node to its next one.
  std::size_t component_step() const { return layout.pitch; }
};

/// Bodies, in the slices of SlicedGraph. A field is an array of records x y z 0: a vector of neighbours is
/// gathered by loading whole records and transposing them in registers. The functions are those of NodeRows.
struct NodeSlices {
  static constexpr std::size_t record_floats = 4;
  /// Numbers of each node in `constants`, after those of its springs.
  enum Constant : std::size_t { free = spring_constant_count, mass, constant_count };

  std::size_t lanes = 0;
  Surroundings surroundings{};
  std::size_t nodes = 0;
  std::vector<std::uint32_t> record;       ///< [nodes] index of a node's record
  std::vector<std::uint32_t> first_entry;  ///< SlicedGraph::first_entry
  AlignedArray entries;                    ///< slice_entries()
  /// [slices][constant_count][lanes] SlicedGraph's constants; 1 if a node moves, else 0; and mass in kg, 0
  /// for padding.
  AlignedArray constants;
  std::vector<IndexRange> chunks;  ///< of slices

  /// Throws Unsupported like SlicedGraph, and for more nodes than entries can address.
  NodeSlices(const System& system, std::size_t lanes);

  std::size_t slices() const { return first_entry.size() - 1; }
  std::size_t field_floats() const { return slices() * lanes * record_floats; }
  static constexpr double sum_factor() { return 1; }
  /// Four per entry.
  std::size_t slope_floats() const { return first_entry.back() * 4 * lanes; }
  std::size_t vectors() const { return slices(); }
  IndexRange floats_of(IndexRange chunk) const {
    const std::size_t slice_floats = lanes * record_floats;
    return {chunk.begin * slice_floats, chunk.end * slice_floats};
  }
  std::size_t offset(std::size_t node) const { return record[node] * record_floats; }
  static constexpr std::size_t component_step() { return 1; }
};

}  // namespace mssim
