#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "geometry/surface.h"
#include "geometry/vec3.h"

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

/// The nodes inside a generated body: points of a body-centred cubic lattice, moved a little at random. (That
/// lattice's tetrahedra are the best shaped that fill space.)
struct InteriorPoints {
  std::uint32_t count = 0;
  std::uint32_t seed = 0;  ///< of the lattice's place and turn and of the moves
  double jitter = 0;       ///< how far a point may move along each axis, in lattice spacings, 0 to 0.5
  double margin = 0;       ///< smallest distance from the surface, in lattice spacings, 0 to 1

  bool operator==(const InteriorPoints&) const = default;
};

/// Where interior points may be.
struct InteriorSpace {
  double volume = 0;  ///< m^3
  Vec3d half_size;    ///< m, of a box around the origin that holds the space
  /// Distance of a point inside from the surface, m; not positive outside.
  std::function<double(const Vec3d&)> depth;
};

/// Exactly `count` points, rounded to micrometres. The spacing (the cube root of the volume for each point)
/// is the largest at which so many points of the lattice lie inside, at least the margin deep; it follows
/// from volume and count. Needs no libm but roots and no std distribution, so that every platform places the
/// same points. Throws InputError for parameters out of range and for more points than fit.
std::vector<Vec3d> place_interior_points(const InteriorPoints& parameters, const InteriorSpace& space);

}  // namespace mssim
