#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/vec3.h"

namespace mssim {

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
