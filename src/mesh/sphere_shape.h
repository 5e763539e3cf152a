#pragma once

#include <cstdint>

#include "geometry/surface.h"

namespace mssim {

/// A sphere around the origin: an icosahedron, each of its triangles cut into frequency^2, pushed out to the
/// radius.
struct SphereShape {
  double radius_m = 0;          ///< m
  std::uint32_t frequency = 0;  ///< triangles along an edge of the icosahedron

  bool operator==(const SphereShape&) const = default;
};

/// Points of the surface: 10 frequency^2 + 2.
std::uint64_t surface_point_count(const SphereShape& sphere);

/// The surface with so many points. Throws InputError for a radius or a frequency that is not
/// positive.
Surface surface_of(const SphereShape& sphere);

/// Distance of a point inside from the sphere, m; not positive outside.
double depth_in(const SphereShape& sphere, const Vec3d& point);

}  // namespace mssim
