#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/draw.h"

namespace mssim {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(a.z, b.z, 1e-12);
}

TEST(ViewDirection, IsANameOrTwoAngles) {
  for (const NamedView& view : named_views()) {
    const auto direction = view_direction(view.name);
    ASSERT_TRUE(direction) << view.name;
    EXPECT_EQ(direction->azimuth, view.direction.azimuth);
  }
  const auto direction = view_direction("-30,12.5");
  ASSERT_TRUE(direction);
  EXPECT_EQ(direction->azimuth, -30);
  EXPECT_EQ(direction->elevation, 12.5);
}

TEST(ViewDirection, IsNothingElse) {
  for (const char* text : {"", "above", "10", "10,", ",10", "10,20,30", "10,91", "10,-91", "nan,0", "0,inf",
                           "361,0", "1 0,0", "10, 5"})
    EXPECT_FALSE(view_direction(text)) << text;
}

TEST(Camera, SeesFromTheFrontXToTheRightAndZNear) { expect_near(Camera({0, 0}).seen({1, 2, 3}), {1, 2, 3}); }

TEST(Camera, SeesFromTheSideBackAndAbove) {
  expect_near(Camera({90, 0}).seen({1, 2, 3}), {-3, 2, 1});
  expect_near(Camera({180, 0}).seen({1, 2, 3}), {-1, 2, -3});
  expect_near(Camera({0, 90}).seen({1, 2, 3}), {1, -3, 2});
}

TEST(Camera, KeepsLengthsAndHandedness) {
  const Camera camera({37, -21});
  expect_near(cross(camera.right(), camera.up()), camera.near());
  EXPECT_NEAR(length(camera.seen({3, 4, 12})), 13, 1e-12);
}

TEST(GridAround, ShowsTheWholeBoxInTheMiddleWithAMargin) {
  for (const Vec3d& high : {Vec3d{4, 1, 0}, Vec3d{1, 4, 0}, Vec3d{0, 0, 0}}) {
    const PixelGrid grid = grid_around({{0, 0, 0}, high}, 200, 100, 0.1);
    EXPECT_EQ(grid.columns, 200U);
    EXPECT_EQ(grid.rows, 100U);
    const double width = 200 * grid.pixel, height = 100 * grid.pixel;
    EXPECT_NEAR(grid.left + width / 2, high.x / 2, 1e-12);
    EXPECT_NEAR(grid.bottom + height / 2, high.y / 2, 1e-12);
    EXPECT_LE(high.x, 0.8 * width * (1 + 1e-12));
    EXPECT_LE(high.y, 0.8 * height * (1 + 1e-12));
    if (high.x > 0) {
      EXPECT_TRUE(std::abs(high.x - 0.8 * width) < 1e-9 || std::abs(high.y - 0.8 * height) < 1e-9);
    }
  }
}

}  // namespace
}  // namespace mssim
