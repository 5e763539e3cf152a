#pragma once

#include <span>
#include <vector>

#include "geometry/surface.h"
#include "geometry/triangle_tree.h"

namespace mssim {

/// The space that a body's surface encloses: exact tests in double precision, with which the fast
/// approximation (BodyMaps) is compared.
///
/// A surface of several connected parts represents their union; parts may overlap. A point is inside a part
/// if the winding number of the part's surface around it is not zero. A ray determines that number, with a
/// bound of the rounding error of every determinant. If a sign is uncertain, because the ray passes too near
/// an edge or vertex, the ray starts at another point on the same side: one nearer to the first point than
/// the surface is. If this fails repeatedly, the sum of the solid angles of all triangles decides, which has
/// no special cases.
///
/// Immutable: threads may use it concurrently.
class Solid {
 public:
  /// Throws InputError unless validate_surface accepts the surface.
  explicit Solid(const Surface& surface);

  /// Depth of a point (m) inside the body, m: the distance from the surface of the part around it, the
  /// largest of these inside several parts, and 0 outside all. A point that is not finite is outside.
  double depth(const Vec3d& point) const;

  /// depth() of each point, on OpenMP's threads.
  std::vector<double> depths(std::span<const Vec3d> points) const;

  /// Distance of a point (m), inside or outside, from the nearest triangle of any part, m.
  double distance(const Vec3d& point) const;

 private:
  std::vector<TriangleTree> parts_;
};

/// The convex hull of a body between two heights: like taut cloth, it bridges hollows. The normals of its
/// planes are 2 degrees apart around the body and up to 30 degrees up and down.
class BandHull {
 public:
  /// Heights are y, m.
  BandHull(const Surface& body, double lowest, double highest);

  /// Distance of a point outside from the hull, m; 0 inside.
  double distance(const Vec3d& point) const;

 private:
  struct Plane {
    Vec3d normal;
    double offset = 0;  ///< m, of the plane along the normal
  };
  std::vector<Plane> planes_;
};

}  // namespace mssim
