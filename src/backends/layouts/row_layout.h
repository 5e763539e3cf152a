#pragma once

#include <cstddef>

#include "model/topology.h"

namespace mssim {

/// Components of each node of a cloth as a structure of arrays, for vectors of nodes beside each other in a
/// row:
///
///     [row -2 .. rows + 1][component][column]
///
/// Column 0 begins a vector, and so does each component of each row. A ring of two nodes surrounds the cloth,
/// so that whatever a spring of the stencil would lead to can be loaded. What lies behind the last column is
/// also what lies before the first one of the next component: a ring is never written and stays zero.
template <std::size_t component_count>
struct RowLayout {
  std::size_t lanes;
  std::size_t rows, columns;  ///< of the cloth
  std::size_t margin;         ///< floats before column 0, whole vectors
  std::size_t pitch;          ///< floats from one component of a row to the next, whole vectors

  RowLayout(const GridPatch& grid, std::size_t lane_count)
      : lanes(lane_count),
        rows(grid.rows),
        columns(grid.columns),
        margin(vectors_of(ring, lanes) * lanes),
        pitch(odd(vectors_of(margin + columns, lanes)) * lanes) {}

  static constexpr std::size_t ring = 2;  ///< longest spring, in rows or columns
  static constexpr std::size_t components = component_count;
  std::size_t row_floats() const { return components * pitch; }
  /// Floats from an array's start to the first component of a node.
  std::size_t offset(std::size_t row, std::size_t column) const {
    return (row + ring) * row_floats() + margin + column;
  }
  /// Floats of an array, with a margin behind its last row.
  std::size_t floats() const { return (rows + 2 * ring) * row_floats() + margin; }

 private:
  static std::size_t vectors_of(std::size_t floats, std::size_t lanes) {
    return (floats + lanes - 1) / lanes;
  }
  /// Where the number of vectors is a power of two, the rows and components that a vector's springs load from
  /// share a few sets of the first-level cache.
  static std::size_t odd(std::size_t vectors) { return vectors % 2 == 0 ? vectors + 1 : vectors; }
};

}  // namespace mssim
