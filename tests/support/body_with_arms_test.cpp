// The person that other tests measure and dress is a closed surface of the size that it is asked for.
#include "tests/support/body_with_arms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/surface.h"

namespace mssim {
namespace {

/// How far a surface reaches along one axis, m.
double extent(const Surface& surface, double Vec3d::*coordinate) {
  const auto [low, high] = std::ranges::minmax(surface.points, {}, coordinate);
  return high.*coordinate - low.*coordinate;
}

class BodyWithArms : public testing::TestWithParam<std::size_t> {};

INSTANTIATE_TEST_SUITE_P(Triangles, BodyWithArms, testing::Values(1'600, 6'000, 24'000),
                         testing::PrintToStringParamName());

TEST_P(BodyWithArms, IsOneClosedSurfaceOfSoManyTriangles) {
  PersonForm form{.triangles = GetParam()};
  const Surface person = body_with_arms(form);
  EXPECT_NO_THROW(validate_surface(person, "person"));
  EXPECT_EQ(closed_parts(person).size(), 1U);
  EXPECT_EQ(person.triangles.size(), GetParam());
  EXPECT_NEAR(extent(person, &Vec3d::y), 1.70, 0.01);
  form.arms = false;
  const Surface trunk = body_with_arms(form);
  EXPECT_EQ(trunk.triangles.size(), GetParam());
  EXPECT_GT(extent(person, &Vec3d::x), extent(trunk, &Vec3d::x) + 0.2);
}

TEST(BodyWithArms, IsPosedAsAFileHasIt) {
  const Surface person = body_with_arms({.triangles = 1'600});
  const Surface in_file =
      posed(person, {.unit_m = 0.01, .turn_degrees = 90, .shift = {1, 0, 0}, .z_up = true});
  EXPECT_NEAR(extent(in_file, &Vec3d::z), 100 * extent(person, &Vec3d::y), 1e-9);
  EXPECT_NEAR(extent(in_file, &Vec3d::y), 100 * extent(person, &Vec3d::x), 1e-9);
  for (std::size_t i = 0; i < person.points.size(); ++i) {
    const Vec3d &from = person.points[i], &to = in_file.points[i];
    EXPECT_NEAR(length(0.01 * to - Vec3d{from.z + 1, from.x, from.y}), 0, 1e-12);
  }
  EXPECT_NO_THROW(validate_surface(in_file, "person"));
}

}  // namespace
}  // namespace mssim
