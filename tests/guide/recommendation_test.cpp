#include "guide/recommendation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "guide/pareto_front.h"
#include "integrators/all_integrators.h"

namespace mssim {
namespace {

/// A point that counts. `cost`: wall seconds a simulated second.
WorkPoint point(std::string_view integrator, double dt_s, double cost, double error,
                const std::string& backend = "openmp") {
  WorkPoint point;
  point.integrator = find_integrator(integrator);
  point.backend = backend;
  point.dt_s = dt_s;
  point.seconds_a_step = cost * dt_s;
  point.position_error = error;
  point.energy_error = 0;
  return point;
}

WorkPoint diverged(WorkPoint point) {
  point.diverged = true;
  return point;
}

WorkPoint beyond_trust(WorkPoint point) {
  point.beyond_trust = true;
  return point;
}

std::vector<std::size_t> front_of(std::vector<WorkPoint> points) {
  mark_pareto_front(points);
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].on_front) front.push_back(i);
  return front;
}

TEST(ParetoFront, HasWhatNothingBeats) {
  const std::vector<WorkPoint> points{
      point("rk4", 1e-3, 3, 1e-6),        point("verlet", 1e-3, 1, 1e-3),
      point("semi-euler", 1e-3, 2, 1e-2),  // slower and worse than verlet
      point("midpoint", 1e-3, 3, 1e-5),    // as fast as rk4, and worse
      point("midpoint", 2e-3, 0.5, 1e-1),
  };
  EXPECT_THAT(front_of(points), testing::ElementsAre(0, 1, 4));
}

TEST(ParetoFront, LeavesOutWhatDoesNotCount) {
  EXPECT_THAT(front_of({diverged(point("rk4", 1e-3, 0.1, 1e-9)), beyond_trust(point("rk4", 1e-3, 0.2, 1e-9)),
                        point("verlet", 1e-3, 1, 1e-3)}),
              testing::ElementsAre(2));
  EXPECT_THAT(front_of({}), testing::IsEmpty());
}

TEST(ParetoFront, KeepsEqualPoints) {
  EXPECT_THAT(front_of({point("rk4", 1e-3, 1, 1e-3), point("verlet", 1e-3, 1, 1e-3)}),
              testing::ElementsAre(0, 1));
}

TEST(StepsAFrame, AreWholeAndNoLonger) {
  EXPECT_EQ(steps_a_frame(1e-4, 60), 167);
  EXPECT_EQ(steps_a_frame(1.0 / 60, 60), 1);
  EXPECT_EQ(steps_a_frame(1.0 / 30, 60), 1);
  EXPECT_EQ(steps_a_frame(0.99 / 60, 60), 2);
}

TEST(Recommendation, IsTheCheapestThatIsAccurateEnough) {
  const std::vector<WorkPoint> points{
      point("semi-euler", 1e-4, 0.2, 2e-3), point("verlet", 1e-4, 0.3, 5e-4),
      point("verlet", 5e-5, 0.6, 1e-4),     point("verlet", 1e-4, 3, 5e-4, "serial"),
      point("rk4", 2e-4, 0.5, 1e-6),        diverged(point("rk4", 4e-4, 0.1, 1e-9)),
  };
  const Recommendation chosen = recommend(points, {60, 1e-3}, 0.05);
  EXPECT_EQ(chosen.best, 1U);
  EXPECT_EQ(chosen.runner_up, 4U);  // of another integrator
  EXPECT_TRUE(chosen.holds_frames);
  ASSERT_EQ(chosen.sentences.size(), 3U);
  EXPECT_THAT(chosen.sentences[0], testing::HasSubstr("Take verlet on openmp with a step of 0.0001 s"));
  EXPECT_THAT(chosen.sentences[0], testing::HasSubstr("167 steps a frame"));
  EXPECT_THAT(chosen.sentences[1], testing::HasSubstr("60 frames a second hold"));
  EXPECT_THAT(chosen.sentences[2], testing::HasSubstr("runner-up is rk4 on openmp"));
  EXPECT_THAT(chosen.sentences[2], testing::HasSubstr("it would win at errors of 1e-06 to 0.0001"));
}

TEST(Recommendation, SaysWhereAFrameTakesTooLong) {
  const Recommendation chosen = recommend(std::vector{point("verlet", 1e-4, 3, 5e-4)}, {60, 1e-3}, 0.05);
  EXPECT_EQ(chosen.best, 0U);
  EXPECT_FALSE(chosen.holds_frames);
  EXPECT_THAT(chosen.sentences[1], testing::HasSubstr("60 frames a second do not hold"));
  EXPECT_THAT(chosen.sentences[2], testing::HasSubstr("No other method"));
}

TEST(Recommendation, TakesAnotherBackendForRunnerUpWhereThereIsNoOtherIntegrator) {
  const std::vector<WorkPoint> points{point("verlet", 1e-4, 0.3, 5e-4),
                                      point("verlet", 1e-4, 3, 5e-4, "serial")};
  const Recommendation chosen = recommend(points, {60, 1e-3}, 0.05);
  EXPECT_EQ(chosen.runner_up, 1U);
  EXPECT_THAT(chosen.sentences[2], testing::HasSubstr("cheaper at no error"));
}

TEST(Recommendation, NamesTheNearestWhereNothingIsAccurateEnough) {
  const std::vector<WorkPoint> points{point("semi-euler", 1e-4, 0.2, 2e-3), point("verlet", 1e-4, 0.9, 1e-3)};
  const Recommendation chosen = recommend(points, {60, 1e-4}, 0.05);
  EXPECT_FALSE(chosen.best);
  EXPECT_EQ(chosen.nearest, 1U);
  ASSERT_EQ(chosen.sentences.size(), 3U);
  EXPECT_THAT(chosen.sentences[0],
              testing::HasSubstr("Nothing that was measured keeps the error within 0.0001"));
}

TEST(Recommendation, SaysThatEverythingDiverged) {
  const Recommendation chosen = recommend(std::vector{diverged(point("rk4", 4e-4, 0.1, 1))}, {60, 1}, 0.05);
  EXPECT_FALSE(chosen.best || chosen.nearest || chosen.runner_up);
  EXPECT_EQ(chosen.sentences.size(), 1U);
}

}  // namespace
}  // namespace mssim
