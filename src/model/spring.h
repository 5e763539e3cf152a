#pragma once

#include <array>
#include <cstdint>
#include <string_view>

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

}  // namespace mssim
