#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "guide/guide.h"
#include "integrators/all_integrators.h"
#include "tests/guide/made_points.h"

namespace mssim {
namespace {

using testing::ElementsAre;

TEST(CostAtError, IsALineThroughTheLogarithms) {
  const std::vector<WorkPoint> points{made_point("rk4", 4e-4, 1, 1e-2), made_point("rk4", 2e-4, 2, 1e-4),
                                      made_point("verlet", 2e-4, 0.1, 1e-6)};
  const GuidedMethod rk4{find_integrator("rk4"), find_backend("openmp"), {}};
  const auto cost = cost_at_error(points, rk4, 1e-3);
  ASSERT_TRUE(cost);
  EXPECT_NEAR(cost->seconds_a_second, std::sqrt(2), 1e-9);
  EXPECT_FALSE(cost->at_longest_step);
  // No longer step than the coarsest, no smaller error than the finest, no other backend.
  EXPECT_NEAR(cost_at_error(points, rk4, 1)->seconds_a_second, 1, 1e-12);
  EXPECT_TRUE(cost_at_error(points, rk4, 1)->at_longest_step);
  EXPECT_FALSE(cost_at_error(points, rk4, 0.9e-4));
  EXPECT_FALSE(cost_at_error(points, {find_integrator("rk4"), find_backend("serial"), {}}, 1));
}

TEST(CostAtError, LeavesOutWhatDoesNotCount) {
  std::vector<WorkPoint> points{made_point("rk4", 4e-4, 1, 1e-3), made_point("rk4", 2e-4, 2, 1e-4)};
  points.front().diverged = true;
  const auto cost = cost_at_error(points, {find_integrator("rk4"), find_backend("openmp"), {}}, 1e-3);
  ASSERT_TRUE(cost);
  EXPECT_NEAR(cost->seconds_a_second, 2, 1e-12);
  EXPECT_TRUE(cost->at_longest_step);
}

SceneGuide guide_of(std::vector<WorkPoint> points) {
  SceneGuide guide;
  guide.wish.error = 1e-3;
  for (const WorkPoint& point : points)
    guide.methods.push_back({point.integrator, find_backend(point.backend), {}});
  guide.points = std::move(points);
  return guide;
}

TEST(BesideThePaper, SaysWhatBecomesOfTheOrder) {
  // A step takes 1, 2 and 4 ms.
  EXPECT_THAT(
      beside_the_paper(guide_of({made_point("semi-euler", 1e-4, 10, 1e-3),
                                 made_point("midpoint", 4e-4, 5, 1e-3), made_point("rk4", 2e-3, 2, 1e-3)})),
      ElementsAre(
          "On openmp a step of semi-euler, midpoint and rk4 takes 1.00, 2.00 and 4.00 ms; at an error "
          "of 0.001 a simulated second takes 10.0, 5.00 and 2.00 s with them: rk4 is the cheapest."));
  EXPECT_THAT(
      beside_the_paper(guide_of({made_point("semi-euler", 1e-3, 1, 1e-3), made_point("rk4", 1e-3, 4, 1e-4)})),
      ElementsAre("On openmp a step of semi-euler and rk4 takes 1.00 and 4.00 ms; at an error of 0.001 a "
                  "simulated second takes 1.00 and 4.00 s with them: the order is the same."));
  EXPECT_THAT(
      beside_the_paper(guide_of({made_point("semi-euler", 1e-3, 1, 1e-2), made_point("rk4", 1e-3, 4, 1e-4)})),
      ElementsAre("On openmp a step of semi-euler and rk4 takes 1.00 and 4.00 ms; at an error of 0.001 a "
                  "simulated second takes 4.00 s with rk4, and semi-euler did not reach it: rk4 is the "
                  "cheapest."));
  EXPECT_THAT(beside_the_paper(guide_of({made_point("semi-euler", 1e-3, 1, 1e-2)})), testing::IsEmpty());
}

TEST(BesideThePaper, SaysHowExplicitEulerStands) {
  SceneGuide guide =
      guide_of({made_point("explicit-euler", 1e-4, 10, 1e-3), made_point("verlet", 4e-4, 2, 1e-3)});
  const auto add_limit = [&](std::string_view name, double stable_s) {
    StepLimit limit;
    limit.integrator = find_integrator(name);
    limit.measured.stable_s = stable_s;
    guide.limits.push_back(limit);
  };
  add_limit("explicit-euler", 1e-4);
  add_limit("semi-euler", 4e-4);
  EXPECT_THAT(
      beside_the_paper(guide),
      ElementsAre(
          "explicit-euler was stable with 0.250 of semi-euler's largest step, and takes 5.00 times as "
          "long as the cheapest method at an error of 0.001."));
}

}  // namespace
}  // namespace mssim
