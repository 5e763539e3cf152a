// The closed lines in which a horizontal plane meets a surface, and whether they overlap.

#include "garment/body/body_profile.h"
#include "garment/body/mannequin.h"
#include "garment/body/trunk_and_legs.h"
#include "mesh/meshing.h"
#include "tests/support/body_with_arms.h"
#include "tests/support/mesh_fixture.h"
#include "tests/support/testing.h"

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

// A hand against a hip is cut off where its section is narrowest; what has no neck stays whole.

constexpr double pi = std::numbers::pi;

/// The loop through the points, each stretch of it in a triangle of its own.
SectionLoop loop_through(const std::vector<PlanPoint>& points) {
  std::vector<std::uint32_t> triangles(points.size());
  std::iota(triangles.begin(), triangles.end(), 0U);
  return loop_of(points, triangles);
}

/// The outline at so many metres from (0, 0) in every direction.
SectionLoop star(const std::function<double(double angle)>& radius) {
  std::vector<PlanPoint> points;
  for (int i = 0; i < 400; ++i) {
    const double angle = 2 * pi * i / 400;
    points.push_back({radius(angle) * std::cos(angle), radius(angle) * std::sin(angle)});
  }
  return loop_through(points);
}

void add_arc(std::vector<PlanPoint>& points, double x, double radius, double from, double to) {
  for (int i = 0; i <= 60; ++i) {
    const double angle = from + (to - from) * i / 60;
    points.push_back({x + radius * std::cos(angle), radius * std::sin(angle)});
  }
}

/// Two circles 2 mm apart, joined by a bridge of 2 cm, as one loop that begins in the first, whose middle is
/// at x.
SectionLoop dumbbell(double x, double first_radius, double second_radius) {
  constexpr double gap = 0.002, half_bridge = 0.01;
  const double first = std::asin(half_bridge / first_radius), second = std::asin(half_bridge / second_radius);
  std::vector<PlanPoint> points;
  add_arc(points, x, first_radius, first, 2 * pi - first);
  add_arc(points, x + first_radius + gap + second_radius, second_radius, second - pi, pi - second);
  return loop_through(points);
}

double circle(double radius) { return pi * radius * radius; }

TEST(SectionNecks, LetAHandBeCutOffTheHip) {
  const SectionLoop whole = dumbbell(0, 0.17, 0.04);
  const std::vector<SectionLoop> parts = cut_at_necks(whole);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_NEAR(parts[0].area, circle(0.17), 0.01 * circle(0.17));
  EXPECT_NEAR(parts[1].area, circle(0.04), 0.05 * circle(0.04));
  EXPECT_NEAR(parts[0].area + parts[1].area, whole.area, 1e-12);
  EXPECT_LT(parts[0].high.x, 0.175);
  EXPECT_GT(parts[1].low.x, 0.165);
  // Each triangle goes with its stretch of the outline.
  for (const std::uint32_t t : parts[1].triangles) EXPECT_GE(t, 60U);
  EXPECT_EQ(parts[0].triangles.front(), 0U);
}

TEST(SectionNecks, AreNotBetweenHalvesNorUnderBulges) {
  EXPECT_EQ(cut_at_necks(dumbbell(-0.091, 0.09, 0.09)).size(), 1U) << "two thighs";
  EXPECT_EQ(cut_at_necks(star([](double) { return 0.17; })).size(), 1U);
  const auto hip = [](double a) { return 0.12 / std::hypot(0.7 * std::cos(a), std::sin(a)); };
  EXPECT_EQ(cut_at_necks(star(hip)).size(), 1U);
  const auto bulging = [](double a) { return 0.15 + 0.04 * std::exp(-std::pow(a - 1.0, 2) / 0.18); };
  EXPECT_EQ(cut_at_necks(star(bulging)).size(), 1U);
}

TEST(SectionNecks, AreNotInTheMiddleOfTheBody) {
  // What hangs before x = 0 is no hand.
  std::vector<PlanPoint> turned;
  for (const PlanPoint& point : dumbbell(0, 0.17, 0.04).points) turned.push_back({-point.z, point.x});
  EXPECT_EQ(cut_at_necks(loop_through(turned)).size(), 1U);
}

TEST(SectionNecks, AreNotAcrossAGapOutside) {
  // A thick ring with a narrow gap at one side. Its ends may be cut off, the hole not.
  std::vector<PlanPoint> points;
  add_arc(points, 0.5, 0.2, 0.1, 2 * pi - 0.1);
  add_arc(points, 0.5, 0.04, 2 * pi - 0.1, 0.1);
  const SectionLoop ring = loop_through(points);
  double sum = 0;
  for (const SectionLoop& part : cut_at_necks(ring)) sum += part.area;
  EXPECT_NEAR(sum, ring.area, 1e-12);
}

// What garments are measured for: a body's trunk and legs, whatever else it has.

/// A block between two corners, m.
Surface block(const Vec3d& low, const Vec3d& high) {
  Surface cube = unit_cube();
  for (Vec3d& point : cube.points)
    point = {low.x + point.x * (high.x - low.x), low.y + point.y * (high.y - low.y),
             low.z + point.z * (high.z - low.z)};
  return cube;
}

Surface without_arms() { return body_with_arms({.triangles = 6'000, .arms = false}); }

/// That both bodies measure the same wherever trousers need it, to a share.
void expect_same_measures(const BodyProfile& profile, const BodyProfile& expected, double fraction) {
  EXPECT_NEAR(profile.crotch_height(), expected.crotch_height(), 0.02);
  for (const double y : {0.82, 0.86, 0.95, 1.04, 1.08}) {
    EXPECT_NEAR(profile.hull_girth(y), expected.hull_girth(y), fraction * expected.hull_girth(y)) << y;
    EXPECT_NEAR(profile.half_width(y), expected.half_width(y), fraction * expected.half_width(y)) << y;
    EXPECT_NEAR(profile.front(y), expected.front(y), 0.006) << y;
    EXPECT_NEAR(profile.back(y), expected.back(y), 0.006) << y;
  }
  for (const double y : {0.09, 0.46, 0.62, 0.70}) {
    for (const int side : {-1, 1}) {
      EXPECT_NEAR(profile.leg_middle(y, side).x, expected.leg_middle(y, side).x, 0.004)
          << y << " side " << side;
      EXPECT_NEAR(profile.leg_girth(y, side), expected.leg_girth(y, side),
                  fraction * expected.leg_girth(y, side))
          << y << " side " << side;
    }
  }
}

class PersonsArms : public testing::TestWithParam<std::size_t> {};

INSTANTIATE_TEST_SUITE_P(Triangles, PersonsArms, testing::Values(1'600, 6'000, 24'000),
                         testing::PrintToStringParamName());

TEST_P(PersonsArms, DoNotCount) {
  const BodyProfile expected(body_with_arms({.triangles = GetParam(), .arms = false}));
  EXPECT_FALSE(expected.trunk_and_legs().left_out);
  const double fraction = GetParam() < 5'000 ? 0.04 : 0.015;
  EXPECT_NEAR(expected.hull_girth(0.86), 0.98, 0.98 * fraction);
  EXPECT_NEAR(expected.hull_girth(1.04), 0.74, 0.74 * fraction);
  EXPECT_NEAR(expected.leg_girth(0.46, 1), 0.37, 0.37 * 0.03);
  for (const double angle : {8.0, 12.0, 40.0}) {
    SCOPED_TRACE(angle);
    const Surface person = body_with_arms({.triangles = GetParam(), .arm_angle_degrees = angle});
    const BodyProfile profile(person);
    expect_same_measures(profile, expected, fraction);
    const TrunkAndLegs& body = profile.trunk_and_legs();
    ASSERT_TRUE(body.left_out);
    EXPECT_GT(body.left_out->high, 1.1);
    EXPECT_LT(body.left_out->low, 0.85);
    EXPECT_FALSE(body.touched);
    EXPECT_NO_THROW(validate_surface(body.surface, "trunk and legs"));
    EXPECT_LT(body.surface.triangles.size(), person.triangles.size());
    EXPECT_GT(body.surface.triangles.size(), person.triangles.size() / 2);
  }
}

TEST(TrunkAndLegs, OfABodyWithoutOtherPartsAreTheBodyItself) {
  for (const Surface& body : {mannequin({}, 48), without_arms(), unit_cube({3, 0, 0}),
                              both(block({-1, 0, 0}, {1, 1, 1}), block({-1, 0.9, 0}, {1, 2, 1}))}) {
    const TrunkAndLegs found = trunk_and_legs(body);
    EXPECT_EQ(found.surface.points, body.points);
    EXPECT_EQ(found.surface.triangles, body.triangles);
    EXPECT_FALSE(found.left_out);
    EXPECT_FALSE(found.touched);
  }
}

TEST(TrunkAndLegs, AreWithoutWhatStandsBesideTheBodyOrHangsFromIt) {
  const Surface person = without_arms();
  const BodyProfile expected(person);
  // A post, a board on the other side, a plait down the back, and fingers below a hand that hangs from the
  // shoulder.
  Surface body = both(person, block({0.5, 0, -0.05}, {0.6, 1.5, 0.05}));
  body = both(body, block({-0.7, 0.5, -0.2}, {-0.6, 0.9, 0.2}));
  body = both(body, block({-0.02, 0.8, -0.19}, {0.02, 1.55, -0.16}));
  body = both(body, block({-0.02, 1.5, -0.19}, {0.02, 1.55, -0.02}));
  body = both(body, block({-0.30, 0.74, -0.04}, {-0.25, 1.36, 0.04}));
  body = both(body, block({-0.30, 1.32, -0.04}, {-0.10, 1.36, 0.04}));
  for (const double z : {-0.03, -0.01, 0.01, 0.03})
    body = both(body, block({-0.28, 0.66, z - 0.008}, {-0.265, 0.76, z + 0.008}));
  const BodyProfile profile(body);
  expect_same_measures(profile, expected, 1e-9);
  EXPECT_FALSE(profile.trunk_and_legs().touched);
  EXPECT_NO_THROW(validate_surface(profile.trunk_and_legs().surface, "trunk and legs"));
}

TEST(TrunkAndLegs, AreWithoutAnArmWhoseHandRestsOnTheHip) {
  const Surface person = without_arms();
  const BodyProfile expected(person);
  // Hand, forearm, upper arm and shoulder, as one arm akimbo.
  Surface body = both(person, block({0.12, 0.90, -0.03}, {0.40, 0.93, 0.03}));
  body = both(body, block({0.36, 0.90, -0.03}, {0.40, 1.36, 0.03}));
  body = both(body, block({0.10, 1.32, -0.03}, {0.40, 1.36, 0.03}));
  const BodyProfile profile(body);
  for (const double y : {0.82, 0.86, 0.95, 1.04, 1.1})
    EXPECT_NEAR(profile.hull_girth(y), expected.hull_girth(y), 1e-9) << y;
  EXPECT_GT(profile.hull_girth(0.915), expected.hull_girth(0.915) + 0.1) << "the hand cannot be told apart";
  const auto touched = profile.trunk_and_legs().touched;
  ASSERT_TRUE(touched);
  EXPECT_NEAR(touched->low, 0.93, 0.01);
  EXPECT_NEAR(touched->high, 0.93, 0.01);
}

TEST_P(PersonsArms, DoNotCountWhereHandsRestAgainstTheHip) {
  const BodyProfile expected(body_with_arms({.triangles = GetParam(), .arms = false}));
  const double fraction = GetParam() < 5'000 ? 0.045 : 0.03;
  for (const double angle : {4.0, 5.0, 6.0}) {
    SCOPED_TRACE(angle);
    const BodyProfile profile(body_with_arms({.triangles = GetParam(), .arm_angle_degrees = angle}));
    const auto touched = profile.trunk_and_legs().touched;
    ASSERT_TRUE(touched);
    EXPECT_GT(touched->low, 0.6);
    EXPECT_LT(touched->high, 1.1);
    EXPECT_NO_THROW(validate_surface(profile.trunk_and_legs().surface, "trunk and legs"));
    // With the hands it would be 1.12 m. At 1.09 m hands nearly touch: what is cut off there leaves spikes.
    for (double y = 0.72; y < 1.1; y += 0.004)
      EXPECT_NEAR(profile.hull_girth(y), expected.hull_girth(y), fraction * expected.hull_girth(y)) << y;
    for (const int side : {-1, 1})
      EXPECT_NEAR(profile.leg_girth(0.7, side), expected.leg_girth(0.7, side), 0.03) << side;
  }
}

TEST(TrunkAndLegs, AreFoundInABodyThatHardlyReachesTheMiddle) {
  // Two posts that a bar of 2 cm joins, beside a third one.
  Surface body = both(block({-0.3, 0, -0.1}, {-0.1, 1, 0.1}), block({0.1, 0, -0.1}, {0.3, 1, 0.1}));
  body = both(body, block({-0.2, 0.5, -0.05}, {0.2, 0.52, 0.05}));
  const TrunkAndLegs found = trunk_and_legs(both(body, block({0.6, 0, -0.1}, {0.8, 1, 0.1})));
  ASSERT_TRUE(found.left_out);
  for (const Vec3d& point : found.surface.points) EXPECT_LT(point.x, 0.31);
}

TEST(TrunkAndLegs, KeepShouldersAndFeet) {
  const Surface person = without_arms();
  // Pads that rise beside the neck, and a foot whose sole is hollow.
  Surface body = both(person, block({0.10, 1.30, -0.03}, {0.16, 1.45, 0.03}));
  body = both(body, block({-0.18, -0.02, -0.05}, {-0.10, 0.05, -0.01}));
  body = both(body, block({-0.18, -0.02, 0.06}, {-0.10, 0.05, 0.12}));
  const TrunkAndLegs found = trunk_and_legs(body);
  EXPECT_EQ(found.surface.triangles, body.triangles);
}

}  // namespace
}  // namespace mssim
