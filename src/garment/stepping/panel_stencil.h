#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "model/system.h"

namespace mssim {

/// The stencil of a panel's nodes: the springs of grid_stencil, each from the node with the lower number, as
/// whoever walks over rows of nodes needs them, and in the order in which elongations are corrected
/// (correction_order.h): structural, shear and bending, of each kind along a row before between rows.
inline constexpr auto panel_stencil = [] {
  auto stencil = grid_stencil;
  for (GridSpring& spring : stencil)
    if (spring.rows < 0) spring = {-spring.rows, -spring.columns, spring.kind};
  std::ranges::sort(stencil, [](const GridSpring& a, const GridSpring& b) {
    if (a.kind != b.kind) return a.kind < b.kind;
    return a.rows != b.rows ? a.rows < b.rows : a.columns > b.columns;
  });
  return stencil;
}();

/// The first so many are limited in their elongation: bending springs, two cells long, may change length by
/// bending.
inline constexpr auto limited_directions = static_cast<std::size_t>(
    std::ranges::count_if(panel_stencil, [](const GridSpring& spring) { return spring.kind != bending; }));

}  // namespace mssim
