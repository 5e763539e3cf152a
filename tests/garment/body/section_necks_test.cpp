// A hand against a hip is cut off where its section is narrowest; what has no neck stays whole.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "garment/body/sections.h"

namespace mssim {
namespace {

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

}  // namespace
}  // namespace mssim
