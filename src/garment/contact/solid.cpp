#include "garment/contact/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

#include "platform/machine.h"

namespace mssim {
namespace {

constexpr double anywhere = std::numeric_limits<double>::infinity();

/// Offsets of the starts of other rays, in units of the distance from the surface: shorter than 1, with
/// ratios of coordinates that meshes do not have.
constexpr std::array<Vec3d, 4> moves{
    {{0.137, 0.541, 0.297}, {-0.219, -0.313, 0.613}, {0.331, -0.467, -0.179}, {-0.083, 0.229, -0.733}}};

bool is_inside(const TriangleTree& part, const Vec3d& point) {
  if (const std::optional<int> winding = part.winding_by_ray(point)) return *winding != 0;
  const double clearance = part.distance(point, anywhere);
  if (!(clearance > 0)) return false;
  for (const Vec3d& move : moves)
    if (const std::optional<int> winding = part.winding_by_ray(point + clearance * move))
      return *winding != 0;
  return part.winding_by_angles(point) != 0;
}

/// The corners of triangles within the band, and the points where edges leave it.
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

Solid::Solid(const Surface& surface) {
  validate_surface(surface, "the body");
  for (const Surface& part : closed_parts(surface)) parts_.emplace_back(part);
}

double Solid::depth(const Vec3d& point) const {
  double deepest = 0;
  for (const TriangleTree& part : parts_)
    if (part.box().contains(point) && is_inside(part, point))
      deepest = std::max(deepest, part.distance(point, anywhere));
  return deepest;
}

std::vector<double> Solid::depths(std::span<const Vec3d> points) const {
  std::vector<double> depths(points.size());
#pragma omp parallel for num_threads(openmp_team(0)) schedule(dynamic, 256)
  for (std::size_t i = 0; i < points.size(); ++i) depths[i] = depth(points[i]);
  return depths;
}

double Solid::distance(const Vec3d& point) const {
  double least = anywhere;
  for (const TriangleTree& part : parts_) least = part.distance(point, least);
  return least;
}

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
