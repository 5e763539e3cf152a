#include "garment/layers/cloth_crossings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <random>

#include "tests/support/cloth_layers_fixture.h"

namespace mssim {
namespace {

/// A level unit square grid of cells, and an upright sheet of one cell across it at an x, from one z to the
/// next (z is -row of the level sheet).
LayeredCloth level_and_upright(std::uint32_t cells, double x, double z_from, double z_to) {
  LayeredCloth cloth;
  cloth.add(0, cells + 1, cells + 1, level(0, 1));
  cloth.add(1, 2, 2, [=](double row, double column) {
    return Vec3d{x, row == 0 ? -1.0 : 1.0, column == 0 ? z_from : z_to};
  });
  return cloth;
}

TEST(CountCrossings, CountsEdgesThroughTriangles) {
  // The upright sheet's two sides and its diagonal go through the level one, whose diagonal goes through it.
  EXPECT_EQ(crossings(level_and_upright(1, 0.4, -0.3, -0.6)), 3U + 1U);
  // Without the level sheet's diagonal, which passes at z = -0.4.
  EXPECT_EQ(crossings(level_and_upright(1, 0.4, -0.5, -0.6)), 3U);
  // Half of it inside: its side at z = -0.6 and the level sheet's border at z = -1. Its diagonal passes the
  // level of the sheet at z = -0.9.
  EXPECT_EQ(crossings(level_and_upright(1, 0.4, -0.6, -1.2)), 2U + 1U);
}

TEST(CountCrossings, FindsNoneBetweenSheetsThatAreApart) {
  EXPECT_EQ(crossings(level_and_upright(1, 1.001, -0.3, -0.6)), 0U);
  LayeredCloth parallel;
  parallel.add(0, 4, 5, level(0, 1));
  parallel.add(1, 4, 5, level(1e-12, 1));
  EXPECT_EQ(crossings(parallel), 0U);
  LayeredCloth interlaced;  // their boxes overlap, and they do not
  interlaced.add(0, 5, 5, [](double row, double column) { return Vec3d{column, column, -row}; });
  interlaced.add(1, 5, 5, [](double row, double column) { return Vec3d{column, column + 0.01, -row}; });
  EXPECT_EQ(crossings(interlaced), 0U);
}

TEST(CountCrossings, CountsAnEdgeThroughASharedSideOnce) {
  // The upright sheet ends on a diagonal, far beyond the other border. Rows of the level sheet at z = -2, -3
  // and -4 and diagonals at -2.5 and -3.5 run through it; its side meets the diagonal at -1.5, which is one
  // crossing, and that diagonal its side, which is one or none.
  EXPECT_THAT(crossings(level_and_upright(4, 1.5, -1.5, -100)), testing::AnyOf(5U + 1U, 5U + 2U));
}

TEST(CountCrossings, CountsTheSameWhicheverWayItIsAsked) {
  std::mt19937 random(5);
  std::size_t all = 0;
  for (int i = 0; i < 20; ++i) {
    const LayeredCloth cloth = folded_sheets(random, 7, 12, 10, 5);
    const auto points = cloth.points();
    const auto &first = cloth.garment.panels[0], &second = cloth.garment.panels[1];
    const std::size_t count = count_crossings(first, second, points);
    EXPECT_EQ(count_crossings(second, first, points), count);
    auto turned = points;  // another axis to sort by
    for (Vec3d& point : turned) point = {point.y, point.z, point.x};
    EXPECT_EQ(count_crossings(first, second, turned), count);
    all += count;
  }
  EXPECT_GT(all, 100U);
}

TEST(ClothContactSearch, TellsTheNodesThatHaveGoneThrough) {
  LayeredCloth cloth;
  cloth.add(0, 6, 6, level(0, 1));
  cloth.add(1, 3, 4, level(-0.1, 0.5, 1.2, -1.3));
  const auto wrong = [&](double reach) { return nodes_on_wrong_side(cloth, reach); };
  // Outer nodes below the inner panel; inner nodes above the outer one, which reaches from x = 1.2 to 2.7 and
  // from z = -1.3 to -2.3: one.
  EXPECT_EQ(wrong(0.11), 12U + 1U);
  EXPECT_EQ(wrong(0.09), 0U);
  cloth.layers.mirrored = {0, 1};
  EXPECT_EQ(wrong(0.11), 0U);
  cloth.layers.mirrored = {0};
  EXPECT_EQ(wrong(0.11), 1U);
}

}  // namespace
}  // namespace mssim
