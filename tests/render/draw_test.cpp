#include "render/draw.h"

#include "tests/support/testing.h"

namespace mssim {
namespace {

constexpr Light red{0.8F, 0.05F, 0.05F}, green{0.05F, 0.8F, 0.05F};

/// A square of two triangles in the plane z = 0, counter-clockwise seen from +z.
Subject square(double half) {
  Subject subject;
  for (const auto& [x, y] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}})
    subject.surface.points.push_back({x, y, 0});
  subject.surface.triangles = {{0, 1, 2}, {0, 2, 3}};
  subject.front.assign(4, red);
  subject.back.assign(4, green);
  return subject;
}

Shot shot_of(const Subject& subject, const ViewDirection& direction) {
  Shot shot;
  shot.direction = direction;
  shot.width = 200;
  shot.height = 150;
  shot.seen = seen_box(Camera(direction), subject.surface.points);
  return shot;
}

bool is_red(const Rgb& pixel) { return pixel.red > 2 * pixel.green; }
bool is_green(const Rgb& pixel) { return pixel.green > 2 * pixel.red; }

TEST(Drawn, ShowsAllOfItAndTheBackgroundAround) {
  const Picture picture = drawn(square(1), shot_of(square(1), {0, 0}));
  EXPECT_EQ(picture.width, 200U);
  EXPECT_EQ(picture.height, 150U);
  EXPECT_TRUE(is_red(picture.at(100, 75)));
  EXPECT_TRUE(is_red(picture.at(100, 12)));  // a margin of 6 % is free
  const Rgb corner = picture.at(0, 0);
  EXPECT_EQ(picture.at(100, 5), corner);
  EXPECT_EQ(picture.at(199, 149), corner);
}

TEST(Drawn, ShowsTheColourOfTheSideThatIsSeen) {
  EXPECT_TRUE(is_red(drawn(square(1), shot_of(square(1), {0, 0})).at(100, 75)));
  EXPECT_TRUE(is_green(drawn(square(1), shot_of(square(1), {180, 0})).at(100, 75)));
}

TEST(Ground, HasLinesARoundNumberOfMetresApart) {
  const Camera above({0, 90});
  for (const auto& [across, spacing] :
       {std::pair{8.0, 1.0}, {2.0, 0.2}, {0.9, 0.1}, {45.0, 5.0}, {1e-3, 1e-4}}) {
    const Ground ground({{0, 0, 0}, {across, across, across}}, 0);
    const Light white_ground{1, 1, 1};
    for (const double line : {0.0, 1.0, 2.0, 3.0}) {
      const Vec3d on{line * spacing, 0, 0.3 * spacing}, between = on + Vec3d{spacing / 2, 0, 0};
      EXPECT_LT(ground.colour_at(on, white_ground, 1, above, 1e-3 * spacing).x, 1) << across;
      EXPECT_EQ(ground.colour_at(between, white_ground, 1, above, 1e-3 * spacing).x, 1) << across;
    }
  }
}

TEST(Ground, IsMetOnlyByACameraAboveIt) {
  const Ground ground({{0, 0, 0}, {1, 1, 1}}, 0.25);
  EXPECT_FALSE(ground.met_by(Camera({30, 0}), 0, 0));
  EXPECT_FALSE(ground.met_by(Camera({30, -20}), 0, 0));
  const Camera camera({30, 20});
  const auto point = ground.met_by(camera, 0.3, -0.4);
  ASSERT_TRUE(point);
  EXPECT_NEAR(point->y, 0.25, 1e-12);
  EXPECT_NEAR(camera.seen(*point).x, 0.3, 1e-12);
  EXPECT_NEAR(camera.seen(*point).y, -0.4, 1e-12);
}

void expect_near(const Vec3d& a, const Vec3d& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(a.z, b.z, 1e-12);
}

TEST(ViewDirection, IsANameOrTwoAngles) {
  for (const auto& [name, azimuth] :
       {std::pair{"front", 0}, {"side", 90}, {"back", 180}, {"three-quarter", 35}}) {
    const auto direction = view_direction(name);
    ASSERT_TRUE(direction) << name;
    EXPECT_EQ(direction->azimuth, azimuth);
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

TEST(Srgb, GivesEveryColourBack) {
  for (int code = 0; code < 256; ++code) {
    const auto channel = static_cast<std::uint8_t>(code);
    const Rgb colour{channel, static_cast<std::uint8_t>(255 - code), 128};
    EXPECT_EQ(colour_of(light_of(colour)), colour) << code;
  }
}

TEST(Srgb, HasAFifthOfTheLightInTheMiddle) {
  EXPECT_NEAR(light_of({128, 128, 128}).x, 0.2159F, 1e-4F);  // IEC 61966-2-1
  EXPECT_EQ(light_of(white).y, 1);
  EXPECT_EQ(light_of(black).z, 0);
}

TEST(Srgb, CutsOffWhatIsBrighterThanWhite) { EXPECT_EQ(colour_of({2, -1, 1}), (Rgb{255, 0, 255})); }

}  // namespace
}  // namespace mssim
