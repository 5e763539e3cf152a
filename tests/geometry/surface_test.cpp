#include "geometry/surface.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/meshing.h"
#include "tests/support/mesh_fixture.h"

namespace mssim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string surface_complaint(const Surface& surface) {
  return input_error_of([&] { validate_surface(surface, "cube"); });
}

TEST(Surface, ClosedSurfacesAreAccepted) {
  EXPECT_EQ(surface_complaint(unit_cube()), "");
  EXPECT_EQ(surface_complaint(both(unit_cube(), unit_cube({2, 0, 0}))), "");
}

TEST(Surface, TheVolumeIsTheEnclosedOne) {
  EXPECT_NEAR(volume_of(unit_cube({1000, 0, 0})), 1, 1e-12);
  EXPECT_NEAR(volume_of(both(unit_cube(), unit_cube({2, 0, 0}))), 2, 1e-12);
}

TEST(Surface, AHoleIsNamedByItsEdge) {
  Surface surface = unit_cube();
  surface.triangles.pop_back();
  EXPECT_THAT(surface_complaint(surface),
              AllOf(StartsWith("cube: the edge from (0, 1, 1) to (0, 0, 1) belongs to one triangle"),
                    HasSubstr("close the hole")));
}

TEST(Surface, AnEdgeOfManyTrianglesIsRefused) {
  Surface surface = unit_cube();
  surface.points.push_back({2, 2, 2});
  surface.triangles.push_back({surface.triangles[0][0], surface.triangles[0][1], 8});
  EXPECT_THAT(surface_complaint(surface), HasSubstr("belongs to 3 triangles"));
}

TEST(Surface, ATriangleTurnedRoundIsRefused) {
  Surface surface = unit_cube();
  std::swap(surface.triangles[4][0], surface.triangles[4][1]);
  EXPECT_THAT(surface_complaint(surface), HasSubstr("in the same direction; turn one of them round"));
}

TEST(Surface, ASurfaceThatPointsInwardsIsRefused) {
  Surface surface = unit_cube();
  for (auto& triangle : surface.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_THAT(surface_complaint(surface), HasSubstr("encloses a volume of -1 m^3; turn its triangles round"));
}

TEST(Surface, BadPointsAndTrianglesAreNamed) {
  Surface surface = unit_cube();
  surface.points[3].y = std::numeric_limits<double>::infinity();
  EXPECT_THAT(surface_complaint(surface), HasSubstr("point 3 (from 0) has the coordinates"));

  surface = unit_cube();
  surface.triangles[2][1] = 8;
  EXPECT_THAT(surface_complaint(surface),
              HasSubstr("triangle 2 (from 0) names point 8 but there are only 8"));

  surface = unit_cube();
  surface.triangles[2][1] = surface.triangles[2][0];
  EXPECT_THAT(surface_complaint(surface), HasSubstr("has no area"));

  surface = unit_cube();
  surface.points.push_back({7, 8, 9});
  EXPECT_THAT(surface_complaint(surface), HasSubstr("the point (7, 8, 9) belongs to no triangle"));

  EXPECT_THAT(surface_complaint({}), HasSubstr("no triangles"));
}

TEST(Surface, GeneratedSurfacesAreClosedAndNearlyFillTheirShape) {
  const double pi = std::numbers::pi;
  const Surface box = surface_of(BoxShape{{0.1, 0.2, 0.3}, {2, 3, 4}});
  EXPECT_EQ(box.points.size(), 2U * (2 * 3 + 3 * 4 + 4 * 2) + 2);
  EXPECT_NEAR(volume_of(box), 0.1 * 0.2 * 0.3, 1e-12);

  const Surface sphere = surface_of(SphereShape{0.5, 7});
  EXPECT_EQ(sphere.points.size(), 10U * 7 * 7 + 2);
  EXPECT_NEAR(volume_of(sphere), 4 * pi / 3 * 0.125, 0.01);
  for (const Vec3d& point : sphere.points) EXPECT_NEAR(dot(point, point), 0.25, 1e-6);

  const Surface torus = surface_of(TorusShape{0.3, 0.1, 40, 15});
  EXPECT_EQ(torus.points.size(), 40U * 15);
  EXPECT_NEAR(volume_of(torus), 2 * pi * pi * 0.3 * 0.01, 0.003);

  for (const Surface& surface : {box, sphere, torus}) EXPECT_EQ(surface_complaint(surface), "");
}

TEST(Surface, CoordinatesAreWholeMicrometres) {
  const Surface sphere = surface_of(SphereShape{0.1234567, 3});
  ASSERT_FALSE(sphere.points.empty());
  for (const Vec3d& point : sphere.points)
    for (const double coordinate : {point.x, point.y, point.z})
      EXPECT_EQ(coordinate, std::round(coordinate * 1e6) / 1e6);
}

TEST(Surface, ShapesThatCannotBeAreRefused) {
  const auto complaint_about = [](const auto& shape) { return input_error_of([&] { surface_of(shape); }); };
  EXPECT_THAT(complaint_about(BoxShape{{1, 0, 1}, {1, 1, 1}}),
              HasSubstr("size along y is 0 m; give a length"));
  EXPECT_THAT(complaint_about(BoxShape{{1, 1, std::nan("")}, {1, 1, 1}}), HasSubstr("size along z is nan m"));
  EXPECT_THAT(complaint_about(BoxShape{{1, 1, 1}, {1, 0, 1}}),
              HasSubstr("cells along a side are 0; give a number"));
  EXPECT_THAT(complaint_about(BoxShape{{1, 1, 1}, {1, 4000000000, 1}}), HasSubstr("4000000000"));
  EXPECT_THAT(complaint_about(SphereShape{-1, 3}), HasSubstr("radius is -1 m"));
  EXPECT_THAT(complaint_about(SphereShape{1, 0}), HasSubstr("(frequency) are 0"));
  EXPECT_THAT(complaint_about(TorusShape{0.3, 0.3, 10, 8}), HasSubstr("leaves no hole"));
  EXPECT_THAT(complaint_about(TorusShape{0.3, 0.1, 11, 8}), HasSubstr("an odd number"));
  EXPECT_THAT(complaint_about(TorusShape{0.3, 0.1, 10, 2}), HasSubstr("cells across are 2"));
}

TEST(InteriorPoints, ExactlySoManyLieInsideAndAwayFromTheSurface) {
  const SphereShape sphere{0.5, 4};
  for (const std::uint32_t count : {1U, 100U, 777U})
    for (const std::uint32_t seed : {1U, 2U}) {
      const std::vector<Vec3d> points = points_of(sphere, {count, seed, 0.2, 0.6}).interior;
      ASSERT_EQ(points.size(), count);
      // The spacing is less than that of the sphere's whole volume, and cannot be less than half of it here.
      const double spacing = std::cbrt(volume_of(surface_of(sphere)) / count);
      for (const Vec3d& point : points) EXPECT_GT(depth_in(sphere, point), 0.6 * spacing / 2);
    }
}

TEST(InteriorPoints, FollowFromTheSeedAlone) {
  const BoxShape box{{1, 1, 1}, {3, 3, 3}};
  const auto points = [&](std::uint32_t seed) { return points_of(box, {50, seed, 0.2, 0.6}).interior; };
  EXPECT_EQ(points(5), points(5));
  EXPECT_NE(points(5), points(6));
}

TEST(InteriorPoints, ParametersOutOfRangeAreRefused) {
  const auto complaint_about = [](const InteriorPoints& interior) {
    return input_error_of([&] { points_of(BoxShape{{1, 1, 1}, {2, 2, 2}}, interior); });
  };
  EXPECT_THAT(complaint_about({2000000, 1, 0, 0.5}), HasSubstr("count of interior points is 2000000"));
  EXPECT_THAT(complaint_about({10, 1, 0.6, 0.5}), HasSubstr("jitter of interior points is 0.6"));
  EXPECT_THAT(complaint_about({10, 1, std::nan(""), 0.5}), HasSubstr("jitter of interior points is nan"));
  EXPECT_THAT(complaint_about({10, 1, 0.1, -1}), HasSubstr("margin of interior points is -1"));
}

}  // namespace
}  // namespace mssim
