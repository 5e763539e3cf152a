#include "mesh/torus_shape.h"

#include <cmath>
#include <numbers>
#include <string>

#include "geometry/geometry.h"
#include "mesh/shape_checks.h"
#include "text/error.h"

namespace mssim {
namespace {

void require_ring(const TorusShape& torus) {
  require_length(torus.major_radius_m, "a torus's major radius");
  require_length(torus.minor_radius_m, "a torus's minor radius");
  require_cells(torus.cells_around, 4, "a torus's cells around");
  require_cells(torus.cells_across, 3, "a torus's cells across");
  if (torus.cells_around % 2 != 0)
    throw InputError("a torus's cells around are " + std::to_string(torus.cells_around) +
                     ", an odd number; every other circle is turned by half a cell, so give an even one");
  if (torus.minor_radius_m >= torus.major_radius_m)
    throw InputError("a torus's minor radius of " + decimal(torus.minor_radius_m) +
                     " m leaves no hole in a ring of " + decimal(torus.major_radius_m) +
                     " m; give one less than the major radius");
}

}  // namespace

std::uint64_t surface_point_count(const TorusShape& torus) {
  return std::uint64_t{torus.cells_around} * torus.cells_across;
}

Surface surface_of(const TorusShape& torus) {
  require_ring(torus);
  constexpr double full_turn = 2 * std::numbers::pi;
  const std::uint32_t around = torus.cells_around;
  const std::uint32_t across = torus.cells_across;
  Surface surface;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = full_turn * i / around;
      const double v = full_turn * (j + (i % 2 == 0 ? 0.0 : 0.5)) / across;
      const double ring = torus.major_radius_m + torus.minor_radius_m * std::cos(v);
      surface.points.push_back(
          rounded({ring * std::cos(u), torus.minor_radius_m * std::sin(v), ring * std::sin(u)}));
    }

  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const auto point = [&](std::uint32_t circle, std::uint32_t place_on_it) {
        return (circle % around) * across + place_on_it % across;
      };
      // Point j of an odd circle lies between points j and j + 1 of the even circles beside it.
      const std::uint32_t a = point(i, j);
      const std::uint32_t b = point(i, j + 1);
      if (i % 2 == 0) {
        surface.triangles.push_back({a, b, point(i + 1, j)});
        surface.triangles.push_back({b, point(i + 1, j + 1), point(i + 1, j)});
      } else {
        surface.triangles.push_back({a, point(i + 1, j + 1), point(i + 1, j)});
        surface.triangles.push_back({a, b, point(i + 1, j + 1)});
      }
    }
  return surface;
}

double depth_in(const TorusShape& torus, const Vec3d& point) {
  const double from_axis = std::sqrt(point.x * point.x + point.z * point.z);
  const double from_circle = from_axis - torus.major_radius_m;
  return torus.minor_radius_m - std::sqrt(from_circle * from_circle + point.y * point.y);
}

}  // namespace mssim
