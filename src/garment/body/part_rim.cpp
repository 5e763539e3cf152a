#include "garment/body/part_rim.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace mssim {
namespace {

constexpr double rim = 0.03;  // m; 2 cm leave thorns, 4 cm join the hip's opening with the armpit's

/// Corners and middles of the triangles that do not stay, from below upwards.
std::vector<Vec3d> left_out_points(const Surface& surface, const std::vector<bool>& stays) {
  std::vector<Vec3d> points;
  for (std::size_t t = 0; t < stays.size(); ++t) {
    if (stays[t]) continue;
    Vec3d sum;
    for (const std::uint32_t corner : surface.triangles[t]) {
      points.push_back(surface.points[corner]);
      sum += surface.points[corner];
    }
    points.push_back(1.0 / 3 * sum);
  }
  std::ranges::sort(points, {}, &Vec3d::y);
  return points;
}

}  // namespace

void leave_out_rim(const Surface& surface, std::vector<bool>& stays) {
  const std::vector<Vec3d> left_out = left_out_points(surface, stays);
  std::vector<bool> is_near(surface.points.size());
  for (std::size_t i = 0; i < is_near.size(); ++i) {
    const Vec3d& point = surface.points[i];
    const auto begin = std::ranges::lower_bound(left_out, point.y - rim, {}, &Vec3d::y);
    for (auto other = begin; other != left_out.end() && other->y <= point.y + rim && !is_near[i]; ++other)
      is_near[i] = length(*other - point) <= rim;
  }
  for (std::size_t t = 0; t < stays.size(); ++t)
    stays[t] = stays[t] && std::ranges::none_of(surface.triangles[t],
                                                [&](std::uint32_t corner) { return is_near[corner]; });
}

}  // namespace mssim
