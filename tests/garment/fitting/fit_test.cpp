// How a garment fits, on garments whose fit is known.

#include <span>

#include "garment/fitting/fitting.h"
#include "tests/support/dressing_systems.h"
#include "tests/support/testing.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Tiers of tubes, one above the other and sewn to each other; their radius is 0.1 m. Each is of so many
/// panels of 5 x 9 nodes, each sewn to the next. The pattern has every node at the height where it is.
System tube(std::uint32_t panels_around = 2, std::uint32_t tiers = 1) {
  System system = garment_of(std::vector<SquarePanel>(panels_around * tiers, {5, 9, 0.04, {0, 0, 0}}));
  Garment& garment = garment_in(system);
  const auto panel = [&](std::uint32_t tier, std::uint32_t i) {
    return garment.panels[panels_around * tier + i % panels_around];
  };
  const auto edge = [](const GarmentPanel& of, std::uint32_t column) {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t row = 0; row < 5; ++row) nodes.push_back(of.node(row, column));
    return nodes;
  };
  for (std::uint32_t tier = 0; tier < tiers; ++tier)
    for (std::uint32_t i = 0; i < panels_around; ++i) {
      const GarmentPanel here = panel(tier, i);
      for (std::uint32_t row = 0; row < 5; ++row)
        for (std::uint32_t column = 0; column < 9; ++column) {
          const std::uint32_t node = here.node(row, column);
          const double angle = 2 * std::numbers::pi * (i + column / 8.0) / panels_around;
          garment.flat[node].y += 0.16 * tier;
          system.start.position[node] = {0.1 * std::cos(angle), garment.flat[node].y, 0.1 * std::sin(angle)};
        }
      sew(system, edge(here, 8), edge(panel(tier, i + 1), 0), 0.16);
      if (tier == 0) continue;
      const GarmentPanel below = panel(tier - 1, i);
      std::vector<std::uint32_t> lower, upper;
      for (std::uint32_t column = 0; column < 9; ++column) {
        lower.push_back(below.node(4, column));
        upper.push_back(here.node(0, column));
      }
      sew(system, lower, upper, 0.32);
    }
  return system;
}

TEST(Fit, CountsRowsThatDoNotGoOnceAroundTheirLimb) {
  const System system = tube();
  const Fit around = fit_of(system, system.start.position, nobody(Vec3d{0, 0, 0.05}));
  EXPECT_EQ(around.rows, 5U);
  EXPECT_EQ(around.rows_astray, 0U);
  EXPECT_LT(around.largest_gap, 1e-15);
  EXPECT_EQ(fit_of(system, system.start.position, nobody(Vec3d{0.2, 0, 0})).rows_astray, 5U);
  // One row is drawn aside.
  std::vector<Vec3d> position = system.start.position;
  for (const GarmentPanel& panel : garment_in(system).panels)
    for (std::uint32_t column = 0; column < panel.columns; ++column) position[panel.node(2, column)].x += 0.3;
  EXPECT_EQ(fit_of(system, position, nobody(Vec3d{})).rows_astray, 1U);
  // A row must go around each of several axes.
  FitBody two_legs = nobody();
  two_legs.limb_axes = [](const Vec3d& middle) {
    return std::vector{Vec3d{-0.05, middle.y, 0}, Vec3d{0.05, middle.y, 0}};
  };
  EXPECT_EQ(fit_of(system, system.start.position, two_legs).rows_astray, 0U);
  for (Vec3d& node : position) node.x += 0.08;
  EXPECT_EQ(fit_of(system, position, two_legs).rows_astray, 5U);
}

TEST(Fit, FollowsRowsFromPanelToPanelAlongTheirSides) {
  for (const std::uint32_t panels_around : {1U, 2U, 3U, 5U})
    for (const std::uint32_t tiers : {1U, 2U}) {
      const System system = tube(panels_around, tiers);
      const Fit fit = fit_of(system, system.start.position, nobody(Vec3d{}));
      EXPECT_EQ(fit.rows, 5 * tiers) << panels_around;
      EXPECT_EQ(fit.rows_astray, 0U) << panels_around;
    }
}

TEST(Fit, HasNoNumberOfRowsWithoutClosedRows) {
  System system = tube();
  std::erase_if(garment_in(system).joints, [](const Joint& joint) { return joint.seam == 1; });
  const Fit fit = fit_of(system, system.start.position, nobody(Vec3d{}));
  EXPECT_FALSE(fit.rows || fit.rows_astray);
  for (const FitCheck& check : fit_checks(fit, {})) EXPECT_THAT(check.name, Not(StartsWith("rows")));
}

TEST(Fit, TellsHowFarUpperEdgesAndTheCrotchHangFromThePattern) {
  System system = tube(2, 2);
  Garment& garment = garment_in(system);
  EXPECT_FALSE(fit_of(system, system.start.position, nobody(Vec3d{})).crotch_rise)
      << "seams that meet make no crotch";
  garment.crotch = {garment.panels[0].node(0, 0)};
  std::vector<Vec3d> position = system.start.position;
  for (Vec3d& node : position) node.y += 0.005;
  position[garment.panels[0].node(0, 0)].y -= 0.025;
  const Fit fit = fit_of(system, position, nobody(Vec3d{}));
  EXPECT_NEAR(fit.upper_edge_rise, 0.005, 1e-12);
  EXPECT_NEAR(fit.crotch_rise.value(), -0.02, 1e-12);
}

TEST(Fit, TellsHowFarCloseClothIsFromTheBodyAndAtWhichHeight) {
  System system = tube();
  // A cylinder of 0.09 m in the tube of 0.1 m.
  FitBody body = nobody(Vec3d{});
  body.distances = [](std::span<const Vec3d> points, double lowest, double highest) {
    EXPECT_EQ(lowest, 0.04);
    EXPECT_EQ(highest, 0.13);
    return mapped<double>(points, [](const Vec3d& point) { return std::hypot(point.x, point.z) - 0.09; });
  };
  std::vector<Vec3d> position = system.start.position;
  const auto side_distance = [&] {
    const Fit fit = fit_of(system, position, body);
    return std::pair(fit.side_distance.value(), fit.side_distance_height.value());
  };
  const std::vector<FitCheck> checks = fit_checks(fit_of(system, position, body), {});
  for (const std::string_view name : {"side_distance_mm", "side_distance_height_m"})
    EXPECT_EQ(std::ranges::count(checks, name, &FitCheck::name), 0) << "nothing is to lie close";
  Garment& garment = garment_in(system);
  const std::uint32_t seam = garment.panels[0].node(2, 0), beside = garment.panels[0].node(3, 1),
                      elsewhere = garment.panels[0].node(3, 4), above = garment.panels[0].node(4, 0);
  garment.close = {{seam, beside, above}, 0.04, 0.13};
  EXPECT_NEAR(side_distance().first, 0.01, 1e-7);
  position[seam].x += 0.005;
  EXPECT_NEAR(side_distance().first, 0.015, 1e-7);
  EXPECT_NEAR(side_distance().second, 0.08, 1e-7);
  position[beside] = 1.2 * position[beside];  // which lifts it to 0.144 m, above what counts
  position[elsewhere].z += 0.1;
  position[above].x += 0.1;
  EXPECT_NEAR(side_distance().first, 0.015, 1e-7);
  position[beside].y = 0.12;
  EXPECT_NEAR(side_distance().first, 0.03, 1e-7);
  EXPECT_NEAR(side_distance().second, 0.12, 1e-7);
}

FitBody body_with_depth(const std::function<double(const Vec3d& point)>& depth) {
  FitBody body = nobody();
  body.depths = [depth](std::span<const Vec3d> points) { return mapped<double>(points, depth); };
  return body;
}

TEST(Fit, MeasuresGapsElongationsAndDepths) {
  System system = garment_of({{2, 3, 0.01, {0, 0, 0}}});
  Garment& garment = garment_in(system);
  garment.seams = {"cut"};
  garment.joints.push_back({0, 1, 2, 0.25, 0.01, 1, 0});
  std::vector<Vec3d> position = system.start.position;
  for (Vec3d& node : position) node = 1.03 * node;
  // The body is what lies under z = 0.002 and left of x = 0.005; cloth is at z = 0.
  const Fit fit = fit_of(system, position, body_with_depth([](const Vec3d& point) {
                           return point.x < 0.005 ? std::max(0.0, 0.002 - point.z) : 0;
                         }));
  EXPECT_NEAR(fit.largest_gap, 1.03 * 0.0125, 1e-9);
  for (const double elongation :
       {fit.elongation_50, fit.elongation_99, fit.elongation_999, fit.elongation_max})
    EXPECT_NEAR(elongation, 0.03, 1e-6);
  EXPECT_EQ(fit.nodes_inside, 2U);
  EXPECT_DOUBLE_EQ(fit.deepest_node, 0.002);
  // No node is inside, but the middle of what is between them.
  const std::vector<Vec3d> spanned{{-0.01, 0, 0},    {0.03, 0, 0},    {0.06, 0, 0},
                                   {-0.01, 0.01, 0}, {0.03, 0.01, 0}, {0.06, 0.01, 0}};
  const Fit around_post =
      fit_of(system, spanned,
             body_with_depth([](const Vec3d& point) { return std::max(0.0, 0.004 - std::abs(point.x)); }));
  EXPECT_EQ(around_post.nodes_inside, 0U);
  EXPECT_EQ(around_post.deepest_node, 0);
  EXPECT_NEAR(around_post.deepest_face_sample, 0.004, 1e-12);  // x = 0 is a quarter of the way
}

TEST(Fit, TakesPercentilesOfElongations) {
  // Two rows of 401 nodes: 800 springs along the rows, 401 between them and 800 across are 2,001. The k-th
  // gap, from 1 to 400, is 0.01 % k wider, and with it its two springs along the rows; those between the rows
  // are as they were, those across longer by about half as much. From the longest on there are so two springs
  // a gap: 99 % of 2,001 leave 20, ten gaps; 99.9 % leave two, one gap. The middle one is the 600th beyond
  // the 401 that are 0, up to an elongation e two springs per 0.01 % along and four across: 600 = 6 e / 0.01
  // %, e = 1 %.
  const System system = garment_of({{2, 401, 0.01, {0, 0, 0}}});
  std::vector<Vec3d> position = system.start.position;
  for (std::uint32_t row = 0; row < 2; ++row)
    for (std::uint32_t column = 1; column <= 400; ++column)
      position[401 * row + column].x = position[401 * row + column - 1].x + 0.01 * (1 + 0.0001 * column);
  const Fit fit = fit_of(system, position, nobody(Vec3d{}));
  EXPECT_NEAR(fit.elongation_50, 0.01, 1e-4);
  EXPECT_NEAR(fit.elongation_99, 0.0390, 1e-6);
  EXPECT_NEAR(fit.elongation_999, 0.0399, 1e-6);
  EXPECT_NEAR(fit.elongation_max, 0.0400, 1e-6);
}

TEST(Fit, TakesTheLayerWhoseUpperEdgesAreFarthestOff) {
  System system = garment_of({{2, 3, 0.1, {0, 0, 0}}, {2, 3, 0.1, {0, 0, 0.1}}});
  std::vector<Vec3d> position = system.start.position;
  for (std::size_t node = 0; node < 12; ++node) position[node].y += node < 6 ? 0.005 : -0.012;
  EXPECT_NEAR(fit_of(system, position, nobody(Vec3d{})).upper_edge_rise, -0.0035, 1e-6);
  garment_in(system).panels[1].layer = 1;
  EXPECT_NEAR(fit_of(system, position, nobody(Vec3d{})).upper_edge_rise, -0.012, 1e-6);
  garment_in(system).panels[0].layer = 2;
  EXPECT_NEAR(fit_of(system, position, nobody(Vec3d{})).upper_edge_rise, -0.012, 1e-6);
}

TEST(Fit, CountsWhereLayersCross) {
  // A square metre at z = 0 and a sheet in the plane x = 0.6 from (y, z) = (0.3, -1) to (2.3, 1): the sheet's
  // lower side runs through the square, and the square's upper side and diagonal through the sheet.
  System system = garment_of({{2, 2, 1, {0, 0, 0}}, {2, 2, 2, {0.6, 0.3, -1}, {0, 0, 1}}});
  EXPECT_EQ(fit_of(system, system.start.position, nobody(Vec3d{})).crossings, 0U) << "in one layer";
  garment_in(system).panels[1].layer = 1;
  EXPECT_EQ(fit_of(system, system.start.position, nobody(Vec3d{})).crossings, 3U);
  for (std::size_t node = 4; node < 8; ++node) system.start.position[node].x += 0.5;
  EXPECT_EQ(fit_of(system, system.start.position, nobody(Vec3d{})).crossings, 0U) << "beside it";
}

TEST(Fit, SamplesBothTrianglesOfEveryCell) {
  const System system = garment_of({{3, 2, 1, {0, 0, 0}}});
  std::vector<Vec3d> position = system.start.position;
  position[3].z = 4;  // the corner far from the first cell's first
  const std::vector<Vec3d> samples = face_samples(garment_in(system).panels[0], position);
  ASSERT_EQ(samples.size(), 2U * 25);
  EXPECT_EQ(samples[0], (Vec3d{0, 0, 0}));
  EXPECT_EQ(samples[24], (Vec3d{1, 1, 4}));
  // In the plane x + y <= 1 the first triangle is flat; beyond it the second rises to the far corner.
  for (std::size_t i = 0; i < 25; ++i)
    EXPECT_NEAR(samples[i].z, std::max(0.0, 4 * (samples[i].x + samples[i].y - 1)), 1e-12) << i;
}

TEST(FitBounds, StandBesideTheNumbersInTheirUnits) {
  const std::vector<FitCheck> checks =
      fit_checks({.largest_gap = 0.0005, .crotch_rise = 0, .elongation_99 = 0.07}, {});
  const auto find = [&](const std::string& name) {
    return *std::ranges::find(checks, name, &FitCheck::name);
  };
  EXPECT_DOUBLE_EQ(find("largest_gap_mm").value, 0.5);
  EXPECT_EQ(find("largest_gap_mm").bound, "1");
  EXPECT_TRUE(find("largest_gap_mm").within.value());
  EXPECT_EQ(find("elongation_99").bound, "0.06");
  EXPECT_FALSE(find("elongation_99").within.value());
  EXPECT_FALSE(find("elongation_max").bound);
  EXPECT_EQ(find("upper_edge_rise_mm").bound, "±20");
  EXPECT_FALSE(find("elongation_max").within);
}

TEST(FitBounds, TellSlidingDownFromBeingPushedUp) {
  DressingResult result;
  result.seamed_at = 100;
  result.settled = true;
  EXPECT_THAT(misfits(result, {.upper_edge_rise = 0.021}, {}),
              ElementsAre(StartsWith("the garment was pushed up: ")));
  EXPECT_THAT(misfits(result, {.crotch_rise = -0.031}, {}),
              ElementsAre(StartsWith("the crotch hangs low: ")));
}

TEST(FitBounds, NameEveryNumberThatIsOutAndNoneThatIsIn) {
  DressingResult result;
  result.seamed_at = 100;
  result.settled = true;
  Fit fit;
  fit.rows = 3;
  EXPECT_THAT(misfits(result, fit, {}), IsEmpty());
  fit = {.largest_gap = 0.0011,
         .nodes_inside = 1,
         .deepest_node = 0.0012,
         .deepest_face_sample = 0.002,
         .side_distance = 0.0125,
         .upper_edge_rise = -0.021,
         .crotch_rise = 0.031,
         .rows = 3,
         .rows_astray = 1,
         .elongation_50 = 0,
         .elongation_99 = 0.061,
         .elongation_999 = std::numeric_limits<double>::quiet_NaN(),
         .elongation_max = 1,
         .crossings = 4};
  EXPECT_THAT(
      misfits({}, fit, {}),
      ElementsAre(
          HasSubstr("seams did not close"), AllOf(HasSubstr("did not come to rest"), HasSubstr("--duration")),
          AllOf(HasSubstr("gap of a seam is 1.1 mm, beyond 1 mm"), HasSubstr("(of jeans: hip_ease_m,")),
          HasSubstr("node inside the body is 1.2 mm"),
          AllOf(StartsWith("the body comes through: "),
                HasSubstr("face inside the body is 2 mm, beyond 1 mm"),
                HasSubstr("; try a larger skin_m or more nodes")),
          AllOf(HasSubstr("99th percentile of elongations is 6.1 %, beyond 6 %"),
                HasSubstr("(of jeans: hip_ease_m,")),
          HasSubstr("99.9th percentile of elongations is nan %"),
          AllOf(StartsWith("the garment slid down: "), HasSubstr("in the pattern is -21 mm, beyond ±20 mm"),
                HasSubstr("; try a lower waist or less ease")),
          AllOf(StartsWith("the crotch was drawn up: "),
                HasSubstr("the crotch from its place in the pattern is 31 mm, beyond ±30 mm")),
          HasSubstr("rows that do not go once around their limb is 1, beyond 0"),
          HasSubstr("layers of the cloth cross is 4, beyond 0"),
          AllOf(StartsWith("the garment stands off at the sides: "),
                HasSubstr("is 12.5 mm, beyond 12 mm; try less hip_ease_m"))));
}

}  // namespace
}  // namespace mssim
