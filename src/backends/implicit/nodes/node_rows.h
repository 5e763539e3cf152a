#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/implicit/nodes/node_chunk.h"
#include "backends/interface/backend.h"
#include "backends/layouts/aligned_array.h"
#include "backends/layouts/row_layout.h"
#include "backends/layouts/spring_constants.h"
#include "model/system.h"

namespace mssim {

/// A cloth as implicit integrators with vectors see it. What they compute with are fields: arrays with a
/// vector in space for each node. The vector code (row_vectors-inl.h) walks over the nodes and loads any
/// field at a node or at its neighbours.
struct NodeRows {
  using Layout = RowLayout<3>;  ///< of a field: x y z
  using Plane = RowLayout<1>;   ///< of one number a node

  static constexpr std::size_t spring_slopes = 4;  ///< numbers of a spring in a field of slopes
  /// Slopes of a field: those of the springs of grid_stencil, at the nodes that own them.
  using SlopeLayout = RowLayout<grid_stencil.size() * spring_slopes>;

  Layout layout;
  SlopeLayout slope_layout;
  Plane plane;
  std::vector<SpringConstants> springs;  ///< [kinds] divided by the mass of a node
  Surroundings surroundings{};
  std::size_t nodes = 0;
  double mass = 0;                        ///< of each node, kg
  AlignedArray free;                      ///< [Plane::floats] 1 at nodes that move, 0 at pins and outside
  std::vector<std::uint8_t> row_is_free;  ///< [rows] 1 where no node of the row is pinned
  std::vector<NodeChunk> chunks;          ///< of rows

  /// `lanes`: floats of a vector. Throws Unsupported where the nodes differ in mass.
  NodeRows(const System& system, const GridPatch& grid, std::size_t lanes);

  /// Floats of a field. They must be zero where no node is, as they are in a new AlignedArray.
  std::size_t field_floats() const { return layout.floats(); }
  /// What a sum over nodes of RowVector::weighted() is to be multiplied with, so that weights are masses.
  double sum_factor() const { return mass; }
  /// Floats of a field of slopes.
  std::size_t slope_floats() const { return slope_layout.floats(); }
  std::size_t row_vectors() const { return (layout.columns + layout.lanes - 1) / layout.lanes; }
  std::size_t vectors() const { return layout.rows * row_vectors(); }
  /// The floats of a field that belong to a chunk's nodes, whole vectors; and zeros beside them.
  NodeChunk floats_of(NodeChunk chunk) const {
    return {(chunk.begin + Layout::ring) * layout.row_floats(),
            (chunk.end + Layout::ring) * layout.row_floats()};
  }
  /// Where the x of a node, by its number in the scene, stands in a field.
  std::size_t offset(std::size_t node) const {
    return layout.offset(node / layout.columns, node % layout.columns);
  }
  /// Floats from a component of a node to its next one.
  std::size_t component_step() const { return layout.pitch; }
};

}  // namespace mssim
