#include "guide/work_precision.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "guide/guide.h"
#include "integrators/all_integrators.h"
#include "tests/support/cloth_system.h"

namespace mssim {
namespace {

/// Points of a method on serial over 10 ms, the limit taken as given, and the trusted state's own error if it
/// is.
std::vector<WorkPoint> curve_of(std::string_view integrator, double stable_s, double wanted_error,
                                double own_error = 0) {
  const System system = cloth_system(8, 8);
  TrustedState trusted =
      trusted_state(system, {.longest_s = 0.01, .first_dt_s = 1e-4, .seconds = 100, .wanted_error = 1e-9});
  trusted.own_error = std::max(trusted.own_error, own_error);
  StepLimit limit;
  limit.integrator = find_integrator(integrator);
  limit.measured = {.stable_s = stable_s, .unstable_s = 1.01 * stable_s};
  GuidedMethod method{limit.integrator, find_backend("serial"), {}};
  WorkCurve curve(system, trusted, limit, method, {.threads = 1}, wanted_error);
  std::vector<WorkPoint> points;
  while (curve.has_next())
    if (const auto measured = curve.next()) points.push_back(measured->point);
  return points;
}

TEST(WorkCurve, FallsWithTheOrderOfItsMethod) {
  const std::vector<WorkPoint> euler = curve_of("semi-euler", 2.2e-4, 1e-3);
  ASSERT_GE(euler.size(), 4U);
  for (std::size_t i = 2; i + 1 < euler.size(); ++i)
    EXPECT_NEAR(*euler[i].position_error / *euler[i + 1].position_error, 2, 0.3) << i;
  const std::vector<WorkPoint> midpoint = curve_of("midpoint", 1.8e-4, 1e-3);
  ASSERT_GE(midpoint.size(), 3U);
  EXPECT_NEAR(*midpoint[1].position_error / *midpoint[2].position_error, 4, 0.8);
}

TEST(WorkCurve, BeginsWithAStepThatDiverges) {
  const std::vector<WorkPoint> points = curve_of("semi-euler", 2.2e-4, 1e-3);
  EXPECT_TRUE(points[0].diverged);
  EXPECT_FALSE(points[0].counts());
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_TRUE(points[i].counts()) << i;
    EXPECT_EQ(points[i].steps, 2 * points[i - 1].steps) << i;
    EXPECT_NEAR(points[i].dt_s * points[i].steps, 0.01, 1e-12) << i;
    EXPECT_EQ(points[i].evaluations, 1) << i;
    EXPECT_GT(points[i].seconds_a_step, 0) << i;
  }
}

TEST(WorkCurve, EndsWithAQuarterOfTheWishedError) {
  const std::vector<WorkPoint> all = curve_of("semi-euler", 2.2e-4, 1e-6);
  ASSERT_GE(all.size(), 6U);
  const double fifth = *all[4].position_error;
  EXPECT_EQ(curve_of("semi-euler", 2.2e-4, 4.01 * fifth).size(), 5U);
  EXPECT_EQ(curve_of("semi-euler", 2.2e-4, 3.99 * fifth).size(), 6U);
}

TEST(WorkCurve, CountsErrorsOfFiftyTimesTheTrustedStatesOrMore) {
  const double second = *curve_of("semi-euler", 2.2e-4, 1e-3)[2].position_error;
  EXPECT_FALSE(curve_of("semi-euler", 2.2e-4, 1e-3, second / 50.1).at(2).beyond_trust);
  EXPECT_TRUE(curve_of("semi-euler", 2.2e-4, 1e-3, second / 49.9).at(2).beyond_trust);
}

TEST(WorkCurve, HasNothingWhereNoStepIsStable) { EXPECT_TRUE(curve_of("explicit-euler", 0, 1e-3).empty()); }

TEST(WorkCurve, CountsNoStepBeyondTheLargestStableOne) {
  const double limit = 0.003;
  const std::vector<WorkPoint> points = curve_of("implicit-euler", limit, 1e-3);
  ASSERT_GE(points.size(), 3U);
  EXPECT_GT(points[0].dt_s, limit);
  for (const WorkPoint& point : points) {
    EXPECT_FALSE(point.diverged) << point.dt_s;
    EXPECT_EQ(point.within_limit, point.dt_s <= limit) << point.dt_s;
    EXPECT_EQ(point.counts(), point.within_limit) << point.dt_s;
  }
  for (const WorkPoint& point : curve_of("implicit-euler", 0, 1e-3))
    EXPECT_FALSE(point.counts()) << point.dt_s;
}

TEST(WorkCurve, OfImplicitMethodsSharesNumbersOfSteps) {
  const Integrator &implicit = *find_integrator("implicit-euler"), &verlet = *find_integrator("verlet");
  // The fewest that are no longer than the longest of use, whatever is stable.
  EXPECT_EQ(first_steps(implicit, {.stable_s = longest_useful_step_s}, 0.1), 3);
  EXPECT_EQ(first_steps(implicit, {.stable_s = 0.004, .unstable_s = 0.00404}, 0.1), 3);
  // Twice the longest stable step.
  EXPECT_EQ(first_steps(verlet, {.stable_s = 0.1 / 950, .unstable_s = 0.1 / 949}, 0.1), 500);
}

TEST(EnergyBound, IsWhatTheSystemHasAndGravityGives) {
  System system = cloth_system(6, 6);
  const double start = energy_of(system, system.start).total();
  EXPECT_GT(energy_bound(system, 0.1), start);
  EXPECT_GT(energy_bound(system, 0.1), energy_bound(system, 0.01));
  // No more than down to the floor.
  EXPECT_DOUBLE_EQ(energy_bound(system, 10), energy_bound(system, 20));
  // 2 kg at 3 m with 2 m/s have 4 J and 60 J. In 0.1 s they fall by 0.05 m, which gives 1 J; in 10 s to the
  // floor.
  system = {};
  system.node_mass = {2};
  system.gravity = 10;
  system.start.position = {{0, 3, 0}};
  system.start.velocity = {{2, 0, 0}};
  EXPECT_NEAR(energy_bound(system, 0.1), 64 + 0.01 * (4 + 1), 1e-12);
  EXPECT_NEAR(energy_bound(system, 10), 64 + 0.01 * (4 + 60), 1e-12);
}

}  // namespace
}  // namespace mssim
