#pragma once

#include <vector>

namespace mssim {

/// A point of a horizontal plane, m.
struct PlanPoint {
  double x = 0, z = 0;

  bool operator==(const PlanPoint&) const = default;
};

/// The length of a string around the points, m: the perimeter of their convex hull (Andrew, "Another
/// efficient algorithm for convex hulls in two dimensions", 1979). 0 for a single point or none, twice the
/// distance for points on a line.
double hull_perimeter(std::vector<PlanPoint> points);

}  // namespace mssim
