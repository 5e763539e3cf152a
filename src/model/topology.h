#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace mssim {

/// A spring between two nodes.
struct Spring {
  std::uint32_t first = 0;   ///< node index
  std::uint32_t second = 0;  ///< node index, another node than `first`
  /// m. Single precision on purpose: every backend, the double-precision reference too, then simulates the
  /// very same springs, and an error against the reference is an error of arithmetic alone.
  float rest_length = 0;
  std::uint32_t kind = 0;  ///< index into System::materials
};

/// How a spring answers stretching.
struct SpringMaterial {
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m, along the spring
};

/// The springs of a regular cloth, by what they resist. The numbers index GridSpringKind tables and
/// materials.
enum GridSpringKind : std::uint32_t { structural, shear, bending };

/// One row per kind of cloth spring: its name in scene files and the length in units of the spacing, squared.
struct GridSpringKindInfo {
  std::string_view name;
  double length_squared;
};
inline constexpr std::array<GridSpringKindInfo, 3> grid_spring_kinds{{
    {"structural", 1},
    {"shear", 2},
    {"bending", 4},
}};

/// One spring of the stencil, from its owner to the other end. Down means higher rows, of panels too.
struct GridSpring {
  int rows;     ///< down
  int columns;  ///< to the right
  GridSpringKind kind;
};

/// The 12-neighbour stencil of Hong et al., Figure 2, each spring named once.
inline constexpr std::array<GridSpring, 6> grid_stencil{{
    {1, 0, structural},
    {0, 1, structural},
    {1, 1, shear},
    {-1, 1, shear},
    {2, 0, bending},
    {0, 2, bending},
}};

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

/// Node indices a, b, c, d of a tetrahedron of positive volume: (b - a) . ((c - a) x (d - a)) > 0.
using Tetrahedron = std::array<std::uint32_t, 4>;

/// The solid bodies of a scene, one after the other. The springs are the edges of the tetrahedra.
struct TetrahedralMesh {
  std::vector<Tetrahedron> tetrahedra;
};

}  // namespace mssim
