#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/surface.h"

namespace mssim {

/// One side of a triangle, in the triangle's direction of travel.
struct SurfaceSide {
  std::uint32_t low = 0, high = 0;  ///< its points
  bool upwards = false;             ///< from low to high
  std::size_t triangle = 0;

  std::uint32_t from() const { return upwards ? low : high; }
  std::uint32_t to() const { return upwards ? high : low; }
};

/// The sides of all triangles, those of one edge next to each other in the order of their triangles.
std::vector<SurfaceSide> sides_by_edge(const Surface& surface);

/// The sides of the edge that begins at `first`.
std::span<const SurfaceSide> sides_of_edge(std::span<const SurfaceSide> sides, std::size_t first);

}  // namespace mssim
