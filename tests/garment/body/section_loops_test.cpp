// The closed lines in which a horizontal plane meets a surface, and whether they overlap.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "garment/body/sections.h"
#include "mesh/shapes.h"
#include "tests/support/mesh_fixture.h"

namespace mssim {
namespace {

std::vector<SectionLoop> loops_at(const Surface& surface, double y) {
  std::vector<std::uint32_t> triangles(surface.triangles.size());
  std::iota(triangles.begin(), triangles.end(), 0U);
  std::vector<SectionLoop> loops = section_loops(surface, triangles, y);
  std::ranges::sort(loops, {}, &SectionLoop::area);
  return loops;
}

/// A loop round a rectangle.
SectionLoop rectangle(double x, double z, double width, double depth) {
  SectionLoop loop;
  loop.points = {{x, z}, {x + width, z}, {x + width, z + depth}, {x, z + depth}};
  loop.low = loop.points[0];
  loop.high = loop.points[2];
  loop.area = width * depth;
  return loop;
}

TEST(SectionLoops, OfATorusAreOneInTheOtherAndBesideEachOther) {
  Surface ring = surface_of(TorusShape{0.5, 0.1, 100, 60});
  // Which axis the ring turns about is the one along which it is thin.
  const auto extent = [&](double Vec3d::*coordinate) {
    return std::ranges::max(ring.points, {}, coordinate).*coordinate;
  };
  const bool is_upright = extent(&Vec3d::y) < 0.2;
  if (!is_upright)
    for (Vec3d& point : ring.points)
      point = extent(&Vec3d::x) < 0.2 ? Vec3d{point.y, point.x, -point.z} : Vec3d{point.x, -point.z, point.y};
  const std::vector<SectionLoop> flat = loops_at(ring, 0.001);
  ASSERT_EQ(flat.size(), 2U);
  EXPECT_NEAR(flat[0].area, std::numbers::pi * 0.4 * 0.4, 0.01);
  EXPECT_NEAR(flat[1].area, std::numbers::pi * 0.6 * 0.6, 0.02);
  EXPECT_TRUE(overlap(flat[0], flat[1]));
  EXPECT_TRUE(overlap(flat[1], flat[0]));

  for (Vec3d& point : ring.points) point = {point.x, -point.z, point.y};
  const std::vector<SectionLoop> standing = loops_at(ring, 0);
  ASSERT_EQ(standing.size(), 2U);
  for (const SectionLoop& loop : standing) EXPECT_NEAR(loop.area, std::numbers::pi * 0.1 * 0.1, 2e-3);
  EXPECT_FALSE(overlap(standing[0], standing[1]));
  EXPECT_TRUE(overlap(standing[0], standing[0]));
}

TEST(SectionLoops, CloseWherePointsAndTrianglesLieInThePlane) {
  const Surface steps = both(unit_cube(), unit_cube({2, -1, 0}));
  // At 0 lies the first cube's floor and the second one's top: the first counts, as points there are above.
  EXPECT_TRUE(loops_at(steps, -1).empty());
  const std::vector<SectionLoop> below = loops_at(steps, 0);
  ASSERT_EQ(below.size(), 1U);
  EXPECT_EQ(below[0].low.x, 2);
  EXPECT_DOUBLE_EQ(below[0].area, 1);
  const std::vector<SectionLoop> top = loops_at(steps, 1);
  ASSERT_EQ(top.size(), 1U);
  EXPECT_EQ(top[0].low.x, 0);
  EXPECT_DOUBLE_EQ(top[0].area, 1);
  EXPECT_EQ(top[0].triangles.size(), 8U) << "each of the sides twice";
}

TEST(SectionLoops, OverlapWhereTheyCrossWithoutACornerInEachOther) {
  const SectionLoop wide = rectangle(-2, -0.5, 4, 1), deep = rectangle(-0.5, -2, 1, 4);
  EXPECT_TRUE(overlap(wide, deep));
  EXPECT_FALSE(overlap(wide, rectangle(-0.5, 0.6, 1, 1)));
  EXPECT_FALSE(overlap(wide, rectangle(2.1, -0.5, 1, 1)));
  // A corner's box reaches into the hook of an L, the loop does not.
  SectionLoop hook = rectangle(0, 0, 3, 3);
  hook.points = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
  EXPECT_FALSE(overlap(hook, rectangle(1.5, 1.5, 1, 1)));
  EXPECT_TRUE(overlap(hook, rectangle(0.5, 1.5, 1, 1)));
}

}  // namespace
}  // namespace mssim
