#include "garment/body/body_profile.h"

#include "garment/body/mannequin.h"
#include "garment/pattern/jeans.h"
#include "mesh/meshing.h"
#include "tests/support/body_with_arms.h"
#include "tests/support/contact_fixture.h"
#include "tests/support/mesh_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// An upright elliptic cylinder with flat ends, its axis at x.
Surface cylinder(double x, double half_width, double half_depth, double low, double high) {
  constexpr std::uint32_t n = 1000;
  Surface surface;
  for (std::uint32_t j = 0; j < n; ++j)
    for (const double y : {low, high}) {
      const double angle = 2 * std::numbers::pi * j / n;
      surface.points.push_back({x + half_width * std::cos(angle), y, half_depth * std::sin(angle)});
    }
  surface.points.push_back({x, low, 0});
  surface.points.push_back({x, high, 0});
  for (std::uint32_t j = 0; j < n; ++j) {
    const std::uint32_t a = 2 * j, b = 2 * ((j + 1) % n);
    surface.triangles.push_back({a, a + 1, b});
    surface.triangles.push_back({b, a + 1, b + 1});
    surface.triangles.push_back({2 * n, a, b});
    surface.triangles.push_back({2 * n + 1, b + 1, a + 1});
  }
  return surface;
}

/// The exact perimeter of an ellipse of which `a` is the longer half axis.
double exact_perimeter(double a, double b) {
  return 4 * a * std::comp_ellint_2(std::sqrt(1 - b * b / (a * a)));
}

/// Half a ring standing on its two ends: an inner radius of 0.8, an outer one of 1.2.
Surface arch(std::uint32_t cells) {
  Surface surface = surface_of(BoxShape{{1, 0.4, 0.3}, {cells, 1, 1}});
  for (Vec3d& point : surface.points) {
    const double angle = std::numbers::pi * point.x;
    const double radius = 1 + point.y;
    point = {radius * std::sin(angle), radius * std::cos(angle), point.z};
  }
  return surface;
}

std::string complaint(const std::function<void()>& body) { return sentence_of<InputError>(body); }

TEST(BodyProfile, ASphereHasTheCirclesOfItsHeights) {
  const BodyProfile profile(surface_of(SphereShape{0.5, 60}));
  EXPECT_NEAR(profile.highest(), 0.5, 1e-3);
  EXPECT_NEAR(profile.lowest(), -0.5, 1e-3);
  for (const double y : {-0.4, -0.123, 0.0, 0.3, 0.45}) {
    const double radius = std::sqrt(0.25 - y * y);
    EXPECT_NEAR(profile.hull_girth(y), 2 * std::numbers::pi * radius, 2e-3 * radius) << y;
    EXPECT_NEAR(profile.front(y), radius, 1e-3) << y;
    EXPECT_NEAR(profile.back(y), -radius, 1e-3) << y;
    EXPECT_NEAR(profile.half_width(y), radius, 1e-3) << y;
  }
}

TEST(BodyProfile, AnEllipticCylinderHasTheGirthOfItsEllipse) {
  const BodyProfile profile(cylinder(0.05, 0.3, 0.2, 0.5, 1.5));
  const double girth = exact_perimeter(0.3, 0.2);
  // The ends are part of the surface.
  for (const double y : {0.5, 0.777, 1.5}) {
    EXPECT_NEAR(profile.hull_girth(y), girth, 1e-5 * girth) << y;
    EXPECT_NEAR(profile.front(y), 0.2, 1e-9) << y;
    EXPECT_NEAR(profile.back(y), -0.2, 1e-9) << y;
    EXPECT_NEAR(profile.half_width(y), 0.35, 1e-9) << y;
  }
}

TEST(BodyProfile, TwoCylindersAreTwoLegs) {
  const BodyProfile profile(both(cylinder(-0.3, 0.1, 0.1, 0, 1), cylinder(0.4, 0.1, 0.1, 0, 1)));
  const double circle = 0.2 * std::numbers::pi;
  EXPECT_NEAR(profile.leg_girth(0.5, -1), circle, 1e-5);
  EXPECT_NEAR(profile.leg_girth(0.5, 1), circle, 1e-5);
  // A string around both: half a circle at either end, and the distance of the axes twice.
  EXPECT_NEAR(profile.hull_girth(0.5), circle + 2 * 0.7, 1e-5);
  EXPECT_NEAR(profile.half_width(0.5), 0.5, 1e-9);
  EXPECT_THAT(complaint([&] { profile.crotch_height(); }),
              AllOf(StartsWith("body: "), HasSubstr("one leg on each side of x = 0")));
}

TEST(BodyProfile, TheTwoLegsAreTakenApartAndTheGirthIsThatOfTheThickerOne) {
  const double thin = 0.2 * std::numbers::pi, thick = exact_perimeter(0.2, 0.1);
  const BodyProfile profile(both(cylinder(-0.3, 0.1, 0.1, 0, 1), cylinder(0.4, 0.2, 0.1, 0, 1)));
  EXPECT_NEAR(profile.leg_girth(0.5, -1), thin, 1e-5);
  EXPECT_NEAR(profile.leg_girth(0.5, 1), thick, 1e-5);
  EXPECT_NEAR(thicker_leg(profile, 0.5).value(), thick, 1e-5);
  const BodyProfile mirrored(both(cylinder(-0.4, 0.2, 0.1, 0, 1), cylinder(0.3, 0.1, 0.1, 0, 1)));
  EXPECT_NEAR(thicker_leg(mirrored, 0.5).value(), thick, 1e-5);
  EXPECT_FALSE(thicker_leg(mirrored, 1.5));
}

TEST(BodyProfile, TheCrotchIsWhereTheSectionFallsApart) {
  // With an even number of cells a point of the arch stands at x = 0, with an odd one the middle of a chord.
  const double half_cell = std::numbers::pi / 2 / 9;
  EXPECT_NEAR(BodyProfile(arch(10)).crotch_height(), 0.8, 1e-12);
  EXPECT_NEAR(BodyProfile(arch(9)).crotch_height(), 0.8 * std::cos(half_cell), 1e-6);

  const Surface legs = both(cylinder(-0.2, 0.1, 0.1, 0, 0.9), cylinder(0.2, 0.1, 0.1, 0, 0.9));
  const Surface trunk = cylinder(0, 0.35, 0.2, 0.8, 1.4);
  EXPECT_NEAR(BodyProfile(both(legs, trunk)).crotch_height(), 0.8, 1e-12);
  for (const double y : {-0.1, 0.3, 0.795, 1.2}) {
    EXPECT_NEAR(BodyProfile(both(legs, trunk)).leg_middle(y, 1).x, 0.2, 1e-9) << y;
    EXPECT_NEAR(BodyProfile(both(legs, trunk)).leg_middle(y, 1).z, 0, 1e-9) << y;
  }
  const Surface plate = cylinder(0, 0.5, 0.5, -0.1, 0.02);
  const BodyProfile statue(both(both(legs, trunk), plate), "statue");
  EXPECT_NEAR(statue.crotch_height(), 0.8, 1e-12);
  EXPECT_NEAR(statue.leg_girth(0.5, -1), 0.2 * std::numbers::pi, 1e-5);
  EXPECT_THAT(complaint([&] { statue.leg_girth(0.01, 1); }),
              StartsWith("statue: its legs are not apart at x = 0 at the height 0.01 m"));
  EXPECT_THAT(complaint([&] { statue.leg_girth(0.85, 1); }), HasSubstr("give a height outside 0.8 to 1.4 m"));
  // Above the crotch it is that of the legs below.
  for (const auto& [y, apart] : {std::pair{0.01, false}, {0.5, true}, {1.2, true}})
    EXPECT_EQ(statue.legs_are_apart(y), apart) << y;
}

TEST(BodyProfile, EachLegHasItsMiddleAndIsAsLongAsItIs) {
  // The right leg is behind the other and ends higher.
  Surface right = cylinder(-0.25, 0.1, 0.1, 0.1, 0.9);
  for (Vec3d& point : right.points) point.z -= 0.2;
  const Surface legs = both(right, cylinder(0.2, 0.1, 0.1, 0, 0.9));
  const BodyProfile body(both(legs, cylinder(0.1, 0.4, 0.4, 0.8, 1.4)));
  for (const double y : {-0.1, 0.05, 0.5, 1.2}) {
    ASSERT_TRUE(body.legs_are_apart(y)) << y;
    EXPECT_NEAR(body.leg_middle(y, -1).x, -0.25, 1e-9) << y;
    EXPECT_NEAR(body.leg_middle(y, -1).z, -0.2, 1e-9) << y;
    EXPECT_NEAR(body.leg_middle(y, 1).x, 0.2, 1e-9) << y;
    EXPECT_NEAR(body.leg_middle(y, 1).z, 0, 1e-9) << y;
  }
  EXPECT_NEAR(body.middle(1.2).x, 0.1, 1e-9);
  EXPECT_NEAR(body.middle(0.5).x, -0.025, 1e-9);
  EXPECT_NEAR(body.middle(0.5).z, -0.1, 1e-9);
}

TEST(BodyProfile, WhatIsNotThereIsNamed) {
  const BodyProfile high(both(cylinder(0.3, 0.1, 0.1, 0, 1), cylinder(-0.3, 0.1, 0.1, 2, 3)), "scan");
  EXPECT_THAT(complaint([&] { high.hull_girth(3.5); }),
              StartsWith("scan: there is no section at the height 3.5 m; give a height from 0 to 3 m"));
  EXPECT_THAT(complaint([&] { high.front(-0.1); }), HasSubstr("no section at the height -0.1 m"));
  EXPECT_THAT(complaint([&] { high.back(std::nan("")); }), HasSubstr("no section at the height"));
  EXPECT_THAT(complaint([&] { high.half_width(1.5); }),
              HasSubstr("a gap between its parts at the height 1.5 m"));
  EXPECT_THAT(complaint([&] { high.leg_girth(0.5, -1); }), HasSubstr("no leg at x < 0 at the height 0.5 m"));
  EXPECT_THAT(complaint([&] { high.leg_girth(2.5, 1); }), HasSubstr("no leg at x > 0"));
  const BodyProfile sphere(surface_of(SphereShape{0.5, 7}));
  EXPECT_THAT(complaint([&] { sphere.crotch_height(); }), HasSubstr("one leg on each side of x = 0"));

  Surface open = cylinder(0, 1, 1, 0, 1);
  open.triangles.pop_back();
  EXPECT_THAT(complaint([&] { BodyProfile(open, "scan"); }), AllOf(StartsWith("scan: "), HasSubstr("hole")));
}

TEST(BodyProfile, TheOrderOfPointsAndTrianglesDoesNotMatter) {
  const Surface body = mannequin({}, 48);
  const BodyProfile expected(body), profile(shuffled(body));
  EXPECT_EQ(profile.lowest(), expected.lowest());
  EXPECT_EQ(profile.highest(), expected.highest());
  EXPECT_NEAR(profile.crotch_height(), expected.crotch_height(), 1e-9);
  // At the first of these heights the points stand in rings.
  for (const double y : {0.09, 0.46, 0.76, 0.3, 0.61})
    EXPECT_NEAR(profile.leg_girth(y, 1), expected.leg_girth(y, 1), 1e-9) << y;
  for (double y = 0.01; y < 1.4; y += 0.0371) {
    EXPECT_NEAR(profile.hull_girth(y), expected.hull_girth(y), 1e-9) << y;
    EXPECT_NEAR(profile.front(y), expected.front(y), 1e-9) << y;
    EXPECT_NEAR(profile.back(y), expected.back(y), 1e-9) << y;
    EXPECT_NEAR(profile.half_width(y), expected.half_width(y), 1e-9) << y;
  }
}

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
  Surface cone = mannequin({}, 48);
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

TEST(Landmarks, AreNotWhereGirthsEnd) {
  // A body that ends above its hip, where it still narrows.
  Surface cut = mannequin({}, 48);
  for (Vec3d& point : cut.points)
    if (point.y > 0.95) point.y = 0.95 + 0.001 * (point.y - 0.95);
  const BodyLandmarks of_cut = find_landmarks(BodyProfile(cut));
  EXPECT_FALSE(of_cut.hip.by_proportion);
  EXPECT_TRUE(of_cut.waist.by_proportion);
  EXPECT_NEAR(of_cut.waist.height, 1.35 * of_cut.crotch_height, 1e-12);
  EXPECT_FALSE(of_cut.waist.girth);
  // Legs that touch from below the range of knees to within it.
  const BodyLandmarks touching =
      find_landmarks(BodyProfile(both(mannequin({}, 48), cylinder(0, 0.1, 0.03, 0.3, 0.5))));
  EXPECT_TRUE(touching.knee.by_proportion);
  EXPECT_NEAR(touching.knee.height, 0.6 * touching.crotch_height, 1e-12);
  EXPECT_FALSE(touching.knee.girth);
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

TEST(JeansForBody, HaveAnEaseThatFitsTheThighs) {
  const BodyProfile profile(mannequin({}));
  const auto jeans_with = [&](double thigh_share) {
    BodyLandmarks body = find_landmarks(profile);
    body.thigh.girth = thigh_share * body.hip.girth.value();
    return jeans_for_body(profile, body);
  };
  constexpr double millimetre = 0.00051;  // to which eases are rounded
  EXPECT_NEAR(jeans_with(0.6).thigh_ease.value(), 0.008 + 0.6 * 0.02, millimetre);
  EXPECT_EQ(jeans_with(0.6).hip_ease, 0);
  EXPECT_NEAR(jeans_with(0.545).thigh_ease.value(), 0.028 + 0.9 * 0.03, millimetre);
  EXPECT_NEAR(jeans_with(0.545).hip_ease, 0.35 * 0.03, millimetre);
  EXPECT_EQ(jeans_with(0.58).thigh_ease, 0.028);
  EXPECT_EQ(jeans_with(0.58).hip_ease, 0);
  EXPECT_EQ(jeans_with(0.7).thigh_ease, -0.013);
  BodyLandmarks unknown = find_landmarks(profile);
  unknown.thigh.girth.reset();
  EXPECT_EQ(jeans_for_body(profile, unknown).thigh_ease, 0.008);
}

TEST(JeansForBody, AreNarrowerAtTheWaistOfABodyThatHardlyWidensBelow) {
  const auto waist_ease = [](const BodyMeasures& measures) {
    const BodyProfile profile(mannequin(measures));
    return jeans_for_body(profile, find_landmarks(profile)).waist_ease;
  };
  EXPECT_EQ(waist_ease({}), 0.01);
  EXPECT_EQ(waist_ease({.waist = {0.97, 1.04}}), -0.015);
}

}  // namespace
}  // namespace mssim
