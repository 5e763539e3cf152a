#include "mesh/shape_mesh.h"

#include "mesh/tetgen.h"
#include "mesh/tetrahedralise.h"

namespace mssim {
namespace {

Vec3d half_size(const BoxShape& box) { return 0.5 * box.size; }
Vec3d half_size(const SphereShape& sphere) { return {sphere.radius_m, sphere.radius_m, sphere.radius_m}; }
Vec3d half_size(const TorusShape& torus) {
  const double outer = torus.major_radius_m + torus.minor_radius_m;
  return {outer, torus.minor_radius_m, outer};
}

}  // namespace

std::uint64_t point_count(const Shape& shape, const InteriorPoints& interior) {
  return std::visit([](const auto& kind) { return surface_point_count(kind); }, shape) + interior.count;
}

ShapePoints points_of(const Shape& shape, const InteriorPoints& interior) {
  return std::visit(
      [&](const auto& kind) {
        ShapePoints points;
        points.surface = surface_of(kind);
        points.interior =
            place_interior_points(interior, {volume_of(points.surface), half_size(kind),
                                             [&](const Vec3d& point) { return depth_in(kind, point); }});
        return points;
      },
      shape);
}

TetMesh shape_mesh(const Shape& shape, const InteriorPoints& interior) {
  require_meshable(point_count(shape, interior));
  const ShapePoints points = points_of(shape, interior);
  return tetrahedralise(points.surface, points.interior, keep_surface);
}

}  // namespace mssim
