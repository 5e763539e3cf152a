#pragma once

#include <array>
#include <cstdint>

#include "geometry/surface.h"

namespace mssim {

/// A box around the origin, its sides along the axes.
struct BoxShape {
  Vec3d size;  ///< m, length of the sides
  std::array<std::uint32_t, 3>
      cells;  ///< squares of the surface along x, y and z, each cut into two triangles

  bool operator==(const BoxShape&) const = default;
};

/// Points of the surface: 2 (ab + bc + ca) + 2 for a x b x c cells.
std::uint64_t surface_point_count(const BoxShape& box);

/// The surface with so many points. Throws InputError for a size that is not
/// positive or for less than one cell.
Surface surface_of(const BoxShape& box);

/// Distance of a point inside from the nearest side, m; not positive outside.
double depth_in(const BoxShape& box, const Vec3d& point);

}  // namespace mssim
