// What a camera sees of a body: depth and normals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "garment/contact/body_maps.h"
#include "geometry/surface.h"
#include "mesh/shapes.h"
#include "tests/support/body_maps_fixture.h"
#include "tests/support/mesh_fixture.h"

namespace mssim {
namespace {

Surface stretched(Surface surface, const Vec3d& by) {
  for (Vec3d& point : surface.points) point = {by.x * point.x, by.y * point.y, by.z * point.z};
  return surface;
}

TEST(SideMap, DepthAndNormalsOfAnEllipsoidAreAsGoodAsItsMesh) {
  const Surface unit = surface_of(SphereShape{1, 24});
  const MeshOfSphere mesh(unit, 1);
  for (const Vec3d& axes : {Vec3d{1, 1, 1}, Vec3d{0.5, 1, 0.7}, Vec3d{1, 0.6, 0.4}}) {
    const Surface ellipsoid = stretched(unit, axes);
    const std::vector<Vec3d> normals = vertex_normals(ellipsoid);
    const auto [shortest, longest] = std::minmax({axes.x, axes.y, axes.z});
    const PixelGrid grid{-1.1, -1.1, 0.01, 220, 220};
    for (const ViewFrom view : {ViewFrom::front, ViewFrom::back}) {
      const SideMap map = side_map(ellipsoid, normals, grid, view);
      const double camera = view == ViewFrom::front ? 1 : -1;
      double error_sum = 0;
      int pixels = 0;
      for (std::uint32_t row = 0; row < grid.rows; ++row)
        for (std::uint32_t column = 0; column < grid.columns; ++column) {
          const double x = grid.centre_x(column) / axes.x, y = grid.centre_y(row) / axes.y;
          const double inner = 1 - mesh.shell - micrometre, outer = 1 + micrometre;
          const std::size_t at = std::size_t{row} * grid.columns + column;
          if (x * x + y * y >= outer * outer) {
            EXPECT_EQ(map.depth[at], -camera * HUGE_VAL);
            EXPECT_EQ(map.normal[at], Vec3d{});
            continue;
          }
          if (x * x + y * y >= inner * inner) continue;
          const double depth = camera * map.depth[at] / axes.z;
          // The fixed-point rounding moves corners by up to 1 / 32768 of a pixel, which matters in steep
          // places.
          const double nearest = std::sqrt(inner * inner - x * x - y * y);
          const double slack = 1e-6 / nearest;
          EXPECT_GE(depth, nearest - slack);
          EXPECT_LE(depth, std::sqrt(outer * outer - x * x - y * y) + slack);
          const Vec3d on_sphere{x, y, camera * std::sqrt(1 - x * x - y * y)};
          const Vec3d exact{on_sphere.x / axes.x, on_sphere.y / axes.y, on_sphere.z / axes.z};
          EXPECT_NEAR(length(map.normal[at]), 1, 1e-12);
          // Normals are stretched by 1 / axes, which changes angles by the ratio of the axes at most. Before
          // the camera the point of the sphere is that beside the mesh's, but steep in the silhouette.
          if (on_sphere.z * camera < 0.2) continue;
          const double error = angle_between(map.normal[at], exact);
          EXPECT_LE(error, longest / shortest * mesh.normal_error());
          error_sum += error;
          ++pixels;
        }
      // A triangle's own normal is half an angle off on average; interpolation is to be far better.
      EXPECT_GT(pixels, 8000);
      EXPECT_LT(error_sum / pixels, 0.1 * longest / shortest * mesh.angle);
    }
  }
}

TEST(VertexNormals, OfABoxPointAlongItsCornersHoweverItsFacesAreCut) {
  // Two triangles meet in some corners of a face and one in others: weighting by angle makes that nothing.
  const Surface cube = unit_cube();
  const std::vector<Vec3d> normals = vertex_normals(cube);
  for (std::size_t p = 0; p < cube.points.size(); ++p) {
    const Vec3d outwards = cube.points[p] - Vec3d{0.5, 0.5, 0.5};
    EXPECT_NEAR(angle_between(normals[p], outwards), 0, 1e-12);
    EXPECT_NEAR(length(normals[p]), 1, 1e-12);
  }
  const Surface larger = inflated(cube, normals, std::sqrt(3.0) / 4);
  for (std::size_t p = 0; p < cube.points.size(); ++p)
    EXPECT_NEAR(length(larger.points[p] - (1.5 * cube.points[p] - Vec3d{0.25, 0.25, 0.25})), 0, 1e-12);
}

}  // namespace
}  // namespace mssim
