#pragma once

#include <cstdint>

#include "geometry/surface.h"

namespace mssim {

/// A ring around the y axis: a circle of the minor radius whose centre goes round the origin at the major
/// radius.
struct TorusShape {
  double major_radius_m = 0;  ///< m
  double minor_radius_m = 0;  ///< m, less than the major one
  std::uint32_t cells_around =
      0;  ///< circles along the ring, an even number: every other one is turned by half a cell
  std::uint32_t cells_across = 0;  ///< points of each circle

  bool operator==(const TorusShape&) const = default;
};

/// Points of the surface: cells_around x cells_across.
std::uint64_t surface_point_count(const TorusShape& torus);

/// The surface with so many points. Throws InputError for radii that make no ring, for an
/// odd number of cells around, and for fewer than 4 around or 3 across.
Surface surface_of(const TorusShape& torus);

/// Distance of a point inside from the ring's surface, m; not positive outside.
double depth_in(const TorusShape& torus, const Vec3d& point);

}  // namespace mssim
