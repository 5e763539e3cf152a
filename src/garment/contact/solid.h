#pragma once

#include <span>
#include <vector>

#include "geometry/surface.h"
#include "geometry/triangle_tree.h"

namespace mssim {

/// A body as the space that its surface encloses: exact tests in double precision, against which what is
/// fast and approximate (BodyMaps) is held.
///
/// A surface of several connected parts stands for their union; parts may overlap. A point is inside a part
/// when the part's surface goes round it, that is when its winding number is not zero. The number is counted
/// along a ray, where every determinant that decides has a bound of its rounding error. Where a sign is not
/// certain, because the ray passes too near an edge or a vertex, the ray starts at another point that must be
/// on the same side, since it is nearer to the point than the surface; and if that fails again and again,
/// the solid angles of all triangles decide, which know no special positions.
///
/// Immutable: threads may ask it at the same time.
class Solid {
 public:
  /// Throws InputError unless validate_surface accepts the surface.
  explicit Solid(const Surface& surface);

  /// How deep the point (m) lies inside, m: 0 outside all parts, inside one part the distance from that
  /// part's surface, inside several the largest of these. A point that is not finite is outside.
  double depth(const Vec3d& point) const;

  /// depth() of each point, by that many threads; 0: as many as OpenMP takes.
  std::vector<double> depths(std::span<const Vec3d> points, int threads = 0) const;

  /// Distance of the point (m) from the nearest triangle of any part, m, inside as outside.
  double distance(const Vec3d& point) const;

 private:
  std::vector<TriangleTree> parts_;
};

/// The convex hull of what a body has between two heights: the body as taut cloth meets it, which bridges
/// hollows. Its planes stand at every second degree around and up to 30 degrees up and down.
class BandHull {
 public:
  /// Heights are y, m.
  BandHull(const Surface& body, double lowest, double highest);

  /// How far outside the point lies, m; 0 inside.
  double distance(const Vec3d& point) const;

 private:
  struct Plane {
    Vec3d normal;
    double offset = 0;  ///< m, of the plane along the normal
  };
  std::vector<Plane> planes_;
};

}  // namespace mssim
