#include <gmock/gmock.h>

#include "garment/body/body_profile.h"
#include "garment/body/mannequin.h"
#include "garment/pattern/jeans.h"
#include "tests/support/body_with_arms.h"
#include "tests/support/mesh_fixture.h"

namespace mssim {
namespace {

using testing::HasSubstr;

void expect_at(const Landmark& found, const GirthAt& expected, double tolerance) {
  EXPECT_NEAR(found.height, expected.height, tolerance);
  ASSERT_TRUE(found.girth);
  EXPECT_NEAR(*found.girth, expected.girth, tolerance);
}

void expect_landmarks(const BodyLandmarks& found, const BodyMeasures& expected, double tolerance) {
  expect_at(found.waist, expected.waist, tolerance);
  expect_at(found.hip, expected.hip, tolerance);
  expect_at(found.thigh, expected.thigh, tolerance);
  // From the thigh to the calf its girth only shrinks.
  EXPECT_TRUE(found.knee.by_proportion);
  expect_at(found.knee, expected.knee, tolerance);
  EXPECT_NEAR(found.crotch_height, expected.crotch_height, tolerance);
  EXPECT_NEAR(found.ankle.girth.value_or(0), expected.ankle.girth, tolerance);
  EXPECT_FALSE(found.waist.by_proportion || found.hip.by_proportion);
}

TEST(Landmarks, AreWhereTheMannequinWasMadeToHaveThem) {
  expect_landmarks(find_landmarks(BodyProfile(mannequin({}))), {}, 0.008);
  BodyMeasures other;
  other.hip = {1.10, 0.88};
  other.waist = {0.92, 1.06};
  other.bust = {1.04, 1.28};
  const BodyLandmarks found = find_landmarks(BodyProfile(mannequin(other)));
  expect_at(found.hip, other.hip, 0.008);
  expect_at(found.waist, other.waist, 0.008);
}

TEST(Landmarks, OfAPersonAreThoseOfTheTrunkWhereverTheArmsHang) {
  for (const double degrees : {12.0, 25.0, 45.0}) {
    PersonForm form;
    form.arm_angle_degrees = degrees;
    SCOPED_TRACE(degrees);
    expect_landmarks(find_landmarks(BodyProfile(body_with_arms(form))), {}, 0.025);
  }
}

TEST(Landmarks, WhatTheBodyDoesNotShowIsByProportion) {
  // A trunk that widens all the way up has neither hip nor waist.
  Surface cone = mannequin({}, {48});
  for (Vec3d& point : cone.points) {
    const double wider = 1 + 4 * std::max(0.0, point.y - 0.78);
    point = {wider * point.x, point.y, wider * point.z};
  }
  const BodyLandmarks found = find_landmarks(BodyProfile(cone));
  EXPECT_TRUE(found.hip.by_proportion);
  EXPECT_TRUE(found.waist.by_proportion);
  EXPECT_NEAR(found.hip.height, 1.12 * found.crotch_height, 1e-12);
  EXPECT_NEAR(found.waist.height, 1.35 * found.crotch_height, 1e-12);
}

TEST(Landmarks, NeedLegs) {
  EXPECT_THAT(input_error_of([] {
                find_landmarks(BodyProfile(unit_cube({-0.5, 0, -0.5})));
              }),
              HasSubstr("never falls apart into a left and a right leg"));
}

TEST(JeansForBody, AreThoseOfTheReferenceBodyAndWideEnoughForAnyLeg) {
  const BodyProfile profile(mannequin({}));
  const JeansMeasures jeans = jeans_for_body(profile, find_landmarks(profile));
  const JeansMeasures reference;
  EXPECT_NEAR(jeans.waist_height, reference.waist_height, 0.01);
  EXPECT_NEAR(jeans.hip_height, reference.hip_height, 0.01);
  EXPECT_NEAR(jeans.knee_height, reference.knee_height, 0.02);
  EXPECT_NEAR(jeans.hem_height, reference.hem_height, 0.02);
  EXPECT_NEAR(jeans.knee, reference.knee, 0.02);
  EXPECT_NEAR(jeans.hem, reference.hem, 0.02);

  BodyLandmarks thin_ankle = find_landmarks(profile);
  thin_ankle.ankle.girth = 0.12;
  const JeansMeasures wide = jeans_for_body(profile, thin_ankle);
  for (double y = wide.hem_height; y < wide.knee_height; y += 0.01) {
    const double fraction = (y - wide.hem_height) / (wide.knee_height - wide.hem_height);
    EXPECT_GT((1 - fraction) * wide.hem + fraction * wide.knee, thicker_leg(profile, y).value() + 0.02) << y;
  }
}

}  // namespace
}  // namespace mssim
