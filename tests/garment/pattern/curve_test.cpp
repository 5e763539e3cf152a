#include "garment/pattern/curve.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/mesh_fixture.h"

namespace mssim {
namespace {

using testing::HasSubstr;

/// The parabola y = x^2 from 0 to 1 as a cubic Bezier segment.
Curve parabola() {
  return Curve::bezier(
      std::array{Vec3d{0, 0, 0}, Vec3d{1.0 / 3, 0, 0}, Vec3d{2.0 / 3, 1.0 / 3, 0}, Vec3d{1, 1, 0}});
}

TEST(Curve, APolylineIsMeasuredAlongItsChords) {
  const Curve curve({{0, 0, 0}, {3, 4, 0}, {3, 9, 0}});
  EXPECT_EQ(curve.length(), 10);
  EXPECT_EQ(curve.at(0), (Vec3d{0, 0, 0}));
  EXPECT_EQ(curve.at(0.5), (Vec3d{3, 4, 0}));
  EXPECT_EQ(curve.at(0.75), (Vec3d{3, 6.5, 0}));
  EXPECT_EQ(curve.at(1), (Vec3d{3, 9, 0}));
}

TEST(Curve, APolygonInACircleHasTheLengthOfItsChords) {
  constexpr int corners = 7;
  constexpr double radius = 0.3;
  std::vector<Vec3d> points;
  for (int i = 0; i <= corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  EXPECT_NEAR(Curve(points).length(), 2 * corners * radius * std::sin(std::numbers::pi / corners), 1e-14);
}

TEST(Curve, ABezierSegmentHasTheArcLengthOfItsParabola) {
  // The integral of sqrt(1 + 4 x^2) from 0 to 1.
  EXPECT_NEAR(parabola().length(), (2 * std::sqrt(5) + std::asinh(2)) / 4, 1e-5);
  const Curve curve = parabola();
  for (const Vec3d& point : curve.points()) EXPECT_NEAR(point.y, point.x * point.x, 1e-15);
}

TEST(Curve, PointsLieByArcLengthHoweverUnevenTheControlPointsAre) {
  const Curve curve =
      Curve::bezier(std::array{Vec3d{0, 0, 0}, Vec3d{0.1, 0, 0}, Vec3d{0.2, 0, 0}, Vec3d{2, 0, 0}});
  EXPECT_NEAR(curve.length(), 2, 1e-14);
  EXPECT_NEAR(curve.at(0.25).x, 0.5, 1e-14);
}

TEST(Curve, AChainOfSegmentsGoesOnFromEndToEnd) {
  const Curve chain = Curve::bezier(std::array{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{2, 0, 0}, Vec3d{3, 0, 0},
                                               Vec3d{3, 1, 0}, Vec3d{3, 2, 0}, Vec3d{3, 3, 0}});
  EXPECT_NEAR(chain.length(), 6, 1e-14);
  EXPECT_NEAR(length(chain.at(0.5) - Vec3d{3, 0, 0}), 0, 1e-14);
  EXPECT_EQ(chain.points().size(), 2 * Curve::chords + 1);
}

TEST(Curve, ASplitCurveIsTheSameInTwo) {
  const Curve curve = parabola();
  const auto [before, after] = curve.split(0.3);
  EXPECT_NEAR(before.length(), 0.3 * curve.length(), 1e-14);
  EXPECT_NEAR(after.length(), 0.7 * curve.length(), 1e-14);
  EXPECT_EQ(before.last(), after.first());
  EXPECT_EQ(before.last(), curve.at(0.3));
  EXPECT_NEAR(before.followed_by(after).length(), curve.length(), 1e-14);
}

TEST(Curve, ASplitAtAPointKeepsItOnceOnEachSide) {
  const auto [before, after] = Curve({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).split(0.5);
  EXPECT_EQ(before.points().size(), 2U);
  EXPECT_EQ(after.points().size(), 2U);
}

TEST(Curve, MirroredItsXIsTurnedRound) {
  EXPECT_EQ(parabola().mirrored().last(), (Vec3d{-1, 1, 0}));
  EXPECT_EQ(parabola().mirrored().length(), parabola().length());
}

TEST(Curve, WhatIsNoCurveIsRefused) {
  const auto complaint = [](std::vector<Vec3d> points) { return input_error_of([&] { Curve{points}; }); };
  EXPECT_THAT(complaint({{0, 0, 0}}), HasSubstr("has 1 point; give two or more points"));
  EXPECT_THAT(
      complaint({{0, 0, 0}, {1, 2, 0}, {1, 2, 0}}),
      HasSubstr("point 2 of a boundary curve, (1, 2, 0), is the same as the one before it; leave one"));
  EXPECT_THAT(complaint({{0, 0, 0}, {1, 2, 3}}),
              HasSubstr("(1, 2, 3), does not lie in the plane of the pattern"));
  EXPECT_THAT(complaint({{0, 0, 0}, {std::numeric_limits<double>::infinity(), 2, 0}}), HasSubstr("finite"));
  EXPECT_THAT(input_error_of([] {
                Curve::bezier(std::array{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{2, 0, 0}});
              }),
              HasSubstr("has 3 points; give 4, 7, 10 or another 3 n + 1 points"));
  EXPECT_THAT(input_error_of([] { parabola().split(1); }),
              HasSubstr("split at 1 of its length; give a fraction"));
}

}  // namespace
}  // namespace mssim
