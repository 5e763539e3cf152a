#pragma once

#include <vector>

#include "geometry/surface.h"

namespace mssim {

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
