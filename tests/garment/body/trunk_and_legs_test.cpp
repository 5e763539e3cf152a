// What garments are measured for: a body's trunk and legs, whatever else it has.
#include "garment/body/trunk_and_legs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "garment/body/body_profile.h"
#include "garment/body/mannequin.h"
#include "tests/support/body_with_arms.h"
#include "tests/support/mesh_fixture.h"

namespace mssim {
namespace {

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
    EXPECT_NEAR(profile.leg_middle(y).x, expected.leg_middle(y).x, 0.004) << y;
    for (const int side : {-1, 1})
      EXPECT_NEAR(profile.leg_girth(y, side), expected.leg_girth(y, side),
                  fraction * expected.leg_girth(y, side))
          << y << " side " << side;
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
  for (const Surface& body : {mannequin({}, {48}), without_arms(), unit_cube({3, 0, 0}),
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
  // A post, a plait down the back, and fingers below a hand that hangs from the shoulder.
  Surface body = both(person, block({0.5, 0, -0.05}, {0.6, 1.5, 0.05}));
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
    // With the hands it would be 1.12 m.
    for (const double y : {0.82, 0.86, 0.90, 0.95, 1.0, 1.04})
      EXPECT_NEAR(profile.hull_girth(y), expected.hull_girth(y), fraction * expected.hull_girth(y)) << y;
    for (const int side : {-1, 1})
      EXPECT_NEAR(profile.leg_girth(0.7, side), expected.leg_girth(0.7, side), 0.03) << side;
  }
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
