#pragma once

#include "geometry/surface.h"
#include "tests/support/testing.h"

namespace mssim {

/// The same numbers on every platform: standard distributions are not.
class RandomPoints {
 public:
  double number(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967295.0;
  }
  Vec3d point(double low, double high) { return {number(low, high), number(low, high), number(low, high)}; }
  /// Of a sphere of radius 1.
  Vec3d direction() {
    while (true)
      if (const Vec3d p = point(-1, 1); length(p) > 0.1 && length(p) <= 1) return (1 / length(p)) * p;
  }
  std::size_t below(std::size_t end) { return engine_() % end; }

 private:
  std::mt19937 engine_{20261122};
};

/// Radius of the largest sphere around the origin that a mesh of a sphere encloses: the mesh lies between it
/// and the sphere.
inline double enclosed_radius(const Surface& sphere) {
  double least = HUGE_VAL;
  for (const auto& [a, b, c] : sphere.triangles) {
    const Vec3d normal = cross(sphere.points[b] - sphere.points[a], sphere.points[c] - sphere.points[a]);
    least = std::min(least, dot(normal, sphere.points[a]) / length(normal));
  }
  return least;
}

/// The surface with its points numbered in another order.
inline Surface renumbered(const Surface& surface) {
  Surface other = surface;
  RandomPoints random;
  std::vector<std::uint32_t> place(surface.points.size());
  for (std::uint32_t p = 0; p < place.size(); ++p) place[p] = p;
  for (std::size_t p = place.size(); p > 1; --p) std::swap(place[p - 1], place[random.below(p)]);
  for (std::size_t p = 0; p < place.size(); ++p) other.points[place[p]] = surface.points[p];
  for (auto& triangle : other.triangles)
    for (std::uint32_t& point : triangle) point = place[point];
  return other;
}

/// That, with its triangles in another order, each beginning with another corner.
inline Surface shuffled(const Surface& surface) {
  Surface other = renumbered(surface);
  RandomPoints random;
  for (std::size_t t = other.triangles.size(); t > 1; --t) {
    auto& triangle = other.triangles[t - 1];
    std::rotate(triangle.begin(), triangle.begin() + static_cast<std::ptrdiff_t>(random.below(3)),
                triangle.end());
    std::swap(triangle, other.triangles[random.below(t)]);
  }
  return other;
}

}  // namespace mssim
