#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/spring.h"

namespace mssim {

/// A regular cloth: rows x columns nodes, row-major, joined by the 12-neighbour stencil.
struct GridPatch {
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  double spacing = 0;              ///< m, between neighbours of a row or a column at rest
  std::uint32_t first_column = 0;  ///< its place in the whole cloth, where this is a window of it

  std::uint32_t nodes() const { return rows * columns; }
  std::uint32_t node(std::uint32_t row, std::uint32_t column) const { return row * columns + column; }
  /// Rest length of one kind of spring, m, as every backend uses it (see Spring::rest_length).
  float rest_length(GridSpringKind kind) const;
};

/// The nodes of some rows and columns of a grid that follow each other.
struct GridWindow {
  std::uint32_t row = 0, column = 0;  ///< the first ones
  std::uint32_t rows = 0, columns = 0;

  std::size_t nodes() const { return std::size_t{rows} * columns; }
};

/// Number of unique springs of a rows x columns grid, without building them:
/// structural 2rc - r - c, shear 2(r-1)(c-1), bending 2rc - 2r - 2c (for grids of at least 2 x 2).
std::uint64_t count_springs(std::uint64_t rows, std::uint64_t columns);

/// The springs of the grid in the order of their owners, each once. Throws nothing but std::bad_alloc.
std::vector<Spring> springs_of(const GridPatch& grid);

}  // namespace mssim
