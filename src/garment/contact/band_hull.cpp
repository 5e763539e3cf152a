#include "garment/contact/band_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace mssim {
namespace {

/// The corners of the triangles within the band, and where their edges leave it.
std::vector<Vec3d> points_of_band(const Surface& body, double lowest, double highest) {
  std::vector<Vec3d> points;
  for (const Vec3d& point : body.points)
    if (point.y >= lowest && point.y <= highest) points.push_back(point);
  for (const auto& triangle : body.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d &from = body.points[triangle[i]], &to = body.points[triangle[(i + 1) % 3]];
      for (const double height : {lowest, highest})
        if (from.y < height && to.y > height)
          points.push_back(from + (height - from.y) / (to.y - from.y) * (to - from));
    }
  return points;
}

}  // namespace

BandHull::BandHull(const Surface& body, double lowest, double highest) {
  const std::vector<Vec3d> points = points_of_band(body, lowest, highest);
  constexpr int step = 2, steepest = 30;  // degrees
  constexpr double radians = std::numbers::pi / 180;
  for (int up = -steepest; up <= steepest; up += step)
    for (int around = 0; around < 360; around += step) {
      const double level = std::cos(up * radians);
      const Vec3d normal{level * std::sin(around * radians), std::sin(up * radians),
                         level * std::cos(around * radians)};
      double offset = -std::numeric_limits<double>::infinity();
      for (const Vec3d& point : points) offset = std::max(offset, dot(normal, point));
      planes_.push_back({normal, offset});
    }
}

double BandHull::distance(const Vec3d& point) const {
  double farthest = 0;
  for (const Plane& plane : planes_) farthest = std::max(farthest, dot(plane.normal, point) - plane.offset);
  return farthest;
}

}  // namespace mssim
