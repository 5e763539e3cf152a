#include "geometry/geometry.h"

#include "geometry/depth_raster.h"
#include "mesh/meshing.h"
#include "tests/support/contact_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

TEST(MonotoneCurve, GoesThroughItsValuesAndStaysBeyondTheEnds) {
  const MonotoneCurve curve({0, 1, 3}, {5, 7, 6});
  EXPECT_EQ(curve(0), 5);
  EXPECT_EQ(curve(1), 7);
  EXPECT_EQ(curve(3), 6);
  EXPECT_EQ(curve(-2), 5);
  EXPECT_EQ(curve(9), 6);
}

TEST(MonotoneCurve, ALineIsALine) {
  const MonotoneCurve curve({0, 1, 1.5, 4}, {1, 3, 4, 9});
  for (double x = 0; x <= 4; x += 0.125) EXPECT_NEAR(curve(x), 1 + 2 * x, 1e-14);
}

TEST(MonotoneCurve, SlopesAreHarmonicMeansThatWeighTheNarrowerSideMore) {
  // Fritsch and Butland: widths 1 and 3, secants 1 and 2 weigh 2 * 3 + 1 = 7 and 3 + 2 * 1 = 5: a slope of
  // 12 / (7 / 1 + 5 / 2) = 24 / 19, and those of the secants at the ends. The cubic halfway is the mean of
  // the values plus an eighth of the width times the difference of the slopes.
  const MonotoneCurve curve({0, 1, 4}, {0, 1, 7});
  EXPECT_NEAR(curve(0.5), 0.5 + (1 - 24. / 19) / 8, 1e-15);
  EXPECT_NEAR(curve(2.5), 4 + 3 * (24. / 19 - 2) / 8, 1e-15);
}

TEST(MonotoneCurve, NeverOvershoots) {
  const MonotoneCurve curve({0, 0.1, 0.2, 1, 1.1}, {0, 0, 1, 1.01, 0.2});
  double before = curve(0);
  for (int i = 1; i <= 1000; ++i) {
    const double now = curve(i / 1000.0);
    EXPECT_GE(now, before);
    before = now;
  }
  for (int i = 1; i <= 100; ++i) {
    const double now = curve(1 + i / 1000.0);
    EXPECT_LE(now, before);
    before = now;
  }
}

constexpr PixelGrid eight{0, 0, 1, 8, 8};

std::uint32_t shown(const std::vector<Fragment>& picture, std::uint32_t column, std::uint32_t row,
                    const PixelGrid& grid = eight) {
  return picture[std::size_t{row} * grid.columns + column].triangle;
}

/// Half of the picture below its falling diagonal, on the plane z = 1 + x / 4 + y / 2.
Surface lower_half() { return {{{0, 0, 1}, {8, 0, 3}, {0, 8, 5}}, {{0, 1, 2}}}; }

TEST(DepthRaster, ATriangleCoversTheCentresInIt) {
  for (const bool turned_round : {false, true}) {
    Surface surface = lower_half();
    if (turned_round) std::swap(surface.triangles[0][0], surface.triangles[0][2]);
    const std::vector<Fragment> picture = rasterise(surface, eight, ViewFrom::front);
    ASSERT_EQ(picture.size(), 64U);
    for (std::uint32_t row = 0; row < 8; ++row)
      for (std::uint32_t column = 0; column < 8; ++column) {
        // Centres on the diagonal, an edge, belong to it.
        const bool covered = column + row <= 7;
        ASSERT_EQ(shown(picture, column, row), covered ? 0 : Fragment::nothing) << column << " " << row;
        if (!covered) continue;
        const Fragment& fragment = picture[row * 8 + column];
        const double x = column + 0.5, y = row + 0.5;
        EXPECT_DOUBLE_EQ(fragment.z, 1 + x / 4 + y / 2);
        const std::size_t origin = turned_round ? 2 : 0;
        EXPECT_FLOAT_EQ(fragment.weights[origin], static_cast<float>(1 - (x + y) / 8));
        EXPECT_FLOAT_EQ(fragment.weights[1], static_cast<float>(x / 8));
        EXPECT_FLOAT_EQ(fragment.weights[2 - origin], static_cast<float>(y / 8));
      }
  }
}

TEST(DepthRaster, EachSideShowsWhatIsNearestToIt) {
  // Two triangles over the whole picture, one before the other on the left and behind it on the right.
  Surface surface{{{-9, -9, 2}, {30, -9, 2}, {-9, 30, 2}, {-9, -9, -9}, {30, -9, 30}, {-9, 30, -9}},
                  {{0, 1, 2}, {3, 4, 5}}};
  const std::vector<Fragment> front = rasterise(surface, eight, ViewFrom::front);
  const std::vector<Fragment> back = rasterise(surface, eight, ViewFrom::back);
  for (std::uint32_t column = 0; column < 8; ++column) {
    const bool second_is_in_front = column + 0.5 > 2;  // the second lies on z = x
    EXPECT_EQ(shown(front, column, 3), second_is_in_front ? 1U : 0U);
    EXPECT_EQ(shown(back, column, 3), second_is_in_front ? 0U : 1U);
  }
}

TEST(DepthRaster, OfTrianglesEquallyNearTheFirstIsShown) {
  Surface surface = lower_half();
  surface.triangles.push_back(surface.triangles.front());
  for (const ViewFrom view : {ViewFrom::front, ViewFrom::back})
    EXPECT_EQ(shown(rasterise(surface, eight, view), 2, 2), 0U);
}

TEST(DepthRaster, WhatIsSeenEdgeOnOrBesideThePictureIsNotShown) {
  const Surface edge_on{{{1, 0, 0}, {1, 8, 0}, {1, 0, 5}}, {{0, 1, 2}}};
  const Surface beside{{{-5, -5, 0}, {-1, -5, 0}, {-5, -1, 0}, {20, 0, 0}, {30, 0, 0}, {20, 9, 0}},
                       {{0, 1, 2}, {3, 4, 5}}};
  for (const Surface& surface : {edge_on, beside})
    for (const Fragment& fragment : rasterise(surface, eight, ViewFrom::front))
      EXPECT_EQ(fragment.triangle, Fragment::nothing);
}

TEST(DepthRaster, AClosedSurfaceHasNoGaps) {
  const double radius = 1;
  const Surface sphere = surface_of(SphereShape{radius, 9});
  const double inner = enclosed_radius(sphere);
  const PixelGrid grid{-1.1, -1.1, 0.01, 220, 220};
  const std::vector<Fragment> front = rasterise(sphere, grid, ViewFrom::front);
  const std::vector<Fragment> back = rasterise(sphere, grid, ViewFrom::back);
  int in_doubt = 0;
  for (std::uint32_t row = 0; row < grid.rows; ++row)
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      const double distance = std::hypot(grid.centre_x(column), grid.centre_y(row));
      const std::size_t pixel = std::size_t{row} * grid.columns + column;
      const bool covered = front[pixel].triangle != Fragment::nothing;
      EXPECT_EQ(back[pixel].triangle != Fragment::nothing, covered);
      if (distance < inner - 1e-6)
        EXPECT_TRUE(covered) << column << " " << row;
      else if (distance > radius + 1e-6)
        EXPECT_FALSE(covered) << column << " " << row;
      else
        ++in_doubt;
      if (covered) {
        EXPECT_LT(back[pixel].z, front[pixel].z + 1e-9);
      }
    }
  EXPECT_LT(in_doubt, 1000);
}

std::string grid_complaint(const PixelGrid& grid) {
  return sentence_of<std::invalid_argument>([&] { rasterise(lower_half(), grid, ViewFrom::front); });
}

TEST(DepthRaster, GridsThatCannotBeAreNamed) {
  EXPECT_EQ(grid_complaint({0, 0, 1, 1, most_pixels_a_side}), "");
  EXPECT_THAT(grid_complaint({0, 0, 0, 8, 8}), HasSubstr("pixels of 0 m; give a positive size"));
  EXPECT_THAT(grid_complaint({0, std::numeric_limits<double>::infinity(), 1, 8, 8}),
              HasSubstr("begins at x = 0 m, y = inf m; give finite numbers"));
  EXPECT_THAT(grid_complaint({0, 0, 1, 0, 8}), HasSubstr("0 x 8 pixels; give 1 to 8192 each way"));
  EXPECT_THAT(grid_complaint({0, 0, 1, 8, most_pixels_a_side + 1}), HasSubstr("8 x 8193 pixels"));
}

}  // namespace
}  // namespace mssim
