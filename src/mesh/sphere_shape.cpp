#include "mesh/sphere_shape.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/geometry.h"
#include "mesh/shape_checks.h"

namespace mssim {
namespace {

/// The corners of an icosahedron: (0, +-1, +-golden ratio) and its cyclic permutations.
std::array<Vec3d, 12> icosahedron_corners() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  return {{{-1, g, 0},
           {1, g, 0},
           {-1, -g, 0},
           {1, -g, 0},
           {0, -1, g},
           {0, 1, g},
           {0, -1, -g},
           {0, 1, -g},
           {g, 0, -1},
           {g, 0, 1},
           {-g, 0, -1},
           {-g, 0, 1}}};
}

constexpr std::array<std::array<std::uint32_t, 3>, 20> icosahedron_faces{{
    {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1},
}};

/// The points of the cut icosahedron. One on an edge belongs to two faces or more, and is the same point for
/// all: it is known by its weights at the corners that it lies between.
class SpherePoints {
 public:
  SpherePoints(const SphereShape& sphere, Surface& surface) : sphere_(sphere), surface_(surface) {}

  /// The point of a face with these weights at its corners; their sum is the frequency.
  std::uint32_t operator()(const std::array<std::uint32_t, 3>& face,
                           const std::array<std::uint32_t, 3>& weights) {
    Weights key{};
    for (std::size_t i = 0; i < 3; ++i)
      if (weights[i] > 0) key[i] = {face[i] + 1, weights[i]};
    std::sort(key.begin(), key.end());
    const auto [entry, is_new] = number_.try_emplace(key, static_cast<std::uint32_t>(surface_.points.size()));
    if (is_new) surface_.points.push_back(position(key));
    return entry->second;
  }

 private:
  /// (corner of the icosahedron counted from 1, weight), ascending; corner 0 is none.
  using Weights = std::array<std::array<std::uint32_t, 2>, 3>;

  Vec3d position(const Weights& weights) const {
    Vec3d sum{};
    for (const auto& [corner, weight] : weights)
      if (corner > 0) sum += static_cast<double>(weight) * corners_[corner - 1];
    return rounded((sphere_.radius_m / length(sum)) * sum);
  }

  const SphereShape& sphere_;
  Surface& surface_;
  std::array<Vec3d, 12> corners_ = icosahedron_corners();
  std::map<Weights, std::uint32_t> number_;
};

}  // namespace

std::uint64_t surface_point_count(const SphereShape& sphere) {
  return 10 * std::uint64_t{sphere.frequency} * sphere.frequency + 2;
}

Surface surface_of(const SphereShape& sphere) {
  require_length(sphere.radius_m, "a sphere's radius");
  require_cells(sphere.frequency, 1, "a sphere's triangles along an edge of the icosahedron (frequency)");
  Surface surface;
  SpherePoints point(sphere, surface);
  const std::uint32_t n = sphere.frequency;
  for (const auto& face : icosahedron_faces)
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; i + j < n; ++j) {
        const auto corner = [&](std::uint32_t second, std::uint32_t third) {
          return point(face, {n - second - third, second, third});
        };
        surface.triangles.push_back({corner(i, j), corner(i + 1, j), corner(i, j + 1)});
        if (i + j + 1 < n)
          surface.triangles.push_back({corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)});
      }
  return surface;
}

double depth_in(const SphereShape& sphere, const Vec3d& point) { return sphere.radius_m - length(point); }

}  // namespace mssim
