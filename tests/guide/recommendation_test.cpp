#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "guide/guide.h"
#include "guide/work_precision.h"
#include "tests/guide/made_points.h"

namespace mssim {
namespace {

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
      made_point("rk4", 1e-3, 3, 1e-6),        made_point("verlet", 1e-3, 1, 1e-3),
      made_point("semi-euler", 1e-3, 2, 1e-2),  // slower and worse than verlet
      made_point("midpoint", 1e-3, 3, 1e-5),    // as fast as rk4, and worse
      made_point("midpoint", 2e-3, 0.5, 1e-1),
  };
  EXPECT_THAT(front_of(points), testing::ElementsAre(0, 1, 4));
}

TEST(ParetoFront, LeavesOutWhatDoesNotCount) {
  EXPECT_THAT(
      front_of({diverged(made_point("rk4", 1e-3, 0.1, 1e-9)),
                beyond_trust(made_point("rk4", 1e-3, 0.2, 1e-9)), made_point("verlet", 1e-3, 1, 1e-3)}),
      testing::ElementsAre(2));
  EXPECT_THAT(front_of({}), testing::IsEmpty());
}

TEST(ParetoFront, KeepsEqualPoints) {
  EXPECT_THAT(front_of({made_point("rk4", 1e-3, 1, 1e-3), made_point("verlet", 1e-3, 1, 1e-3)}),
              testing::ElementsAre(0, 1));
}

TEST(StepsAFrame, AreWholeAndNoLonger) {
  EXPECT_EQ(steps_a_frame(1e-4, 60), 167);
  EXPECT_EQ(steps_a_frame(1.0 / 60, 60), 1);
  EXPECT_EQ(steps_a_frame(1.0 / 30, 60), 1);
  EXPECT_EQ(steps_a_frame(0.99 / 60, 60), 2);
}

TEST(StepsAFrame, AreNoneMoreWhereOnlyRoundingSaysSo) {
  for (int steps = 1; steps <= 5000; ++steps)
    for (const double rate : {24.0, 30.0, 59.94, 60.0})
      EXPECT_EQ(steps_a_frame(1 / (rate * steps), rate), steps) << rate;
}

TEST(Recommendation, IsTheCheapestThatIsAccurateEnough) {
  const std::vector<WorkPoint> points{
      made_point("semi-euler", 1e-4, 0.2, 2e-3), made_point("verlet", 1e-4, 0.3, 5e-4),
      made_point("verlet", 5e-5, 0.6, 1e-4),     made_point("verlet", 1e-4, 3, 5e-4, "serial"),
      made_point("rk4", 2e-4, 0.5, 1e-6),        diverged(made_point("rk4", 4e-4, 0.1, 1e-9)),
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
  EXPECT_THAT(chosen.sentences[2], testing::HasSubstr("it would win at errors of 1e-06 to below 0.0005."));
}

/// Each of two methods is the cheaper one for some errors between those for which the other is.
const std::vector<WorkPoint> by_turns{
    made_point("rk4", 1e-5, 5, 1e-6),   made_point("verlet", 1e-5, 4, 1e-5),
    made_point("rk4", 2e-5, 2, 1e-4),   made_point("verlet", 1e-4, 0.3, 5e-4),
    made_point("rk4", 1e-4, 0.1, 5e-3), made_point("verlet", 1e-3, 0.05, 2e-2),
};

std::string runner_up_sentence(const std::vector<WorkPoint>& points) {
  return recommend(points, {60, 1e-3}, 0.05).sentences.at(2);
}

TEST(Recommendation, LeavesOutErrorsBetweenThoseForWhichTheRunnerUpIsCheaper) {
  // At 5e-4, say, the winner's own error, it is not.
  EXPECT_THAT(runner_up_sentence(by_turns),
              testing::EndsWith("it would win at errors of 1e-06 to below 1e-05, 0.0001 to below 0.0005 and "
                                "0.005 to below 0.02."));
  std::vector<WorkPoint> many = by_turns;
  many.push_back(made_point("rk4", 2e-3, 0.01, 5e-2));
  EXPECT_THAT(runner_up_sentence(many), testing::EndsWith("0.005 to below 0.02 and some larger ones."));
}

TEST(Recommendation, SaysThatTheRunnerUpIsCheaperFromAnErrorOn) {
  EXPECT_THAT(runner_up_sentence({made_point("rk4", 1e-4, 2, 1e-4), made_point("verlet", 1e-4, 0.3, 1e-4),
                                  made_point("rk4", 1e-3, 0.1, 5e-3)}),
              testing::EndsWith("it would win at errors of 0.005 or more."));
}

TEST(Recommendation, TellsNoRangeWhoseEndsAreTheSameInTwoDigits) {
  EXPECT_THAT(
      runner_up_sentence({made_point("rk4", 1e-4, 0.5, 1e-4), made_point("verlet", 1e-4, 0.3, 1.001e-4)}),
      testing::EndsWith("it would win at errors of about 0.0001."));
}

TEST(Recommendation, SaysWhereAFrameTakesTooLong) {
  const Recommendation chosen =
      recommend(std::vector{made_point("verlet", 1e-4, 3, 5e-4)}, {120, 1e-3}, 0.05);
  EXPECT_EQ(chosen.best, 0U);
  EXPECT_FALSE(chosen.holds_frames);
  EXPECT_THAT(chosen.sentences[1], testing::HasSubstr("120 frames a second do not hold"));
  EXPECT_THAT(chosen.sentences[2], testing::HasSubstr("No other method"));
}

TEST(Recommendation, CountsWholeStepsForTheTimeOfAFrame) {
  // 60 frames a second have 2.5 steps of 1/150 s each, so that 3 are taken. At 6 ms a step these take 18
  // ms, 55.6 frames a second; 2.5 would take 15 ms, and a frame lasts 16.7 ms.
  const Recommendation chosen =
      recommend(std::vector{made_point("verlet", 1.0 / 150, 0.9, 5e-4)}, {60, 1e-3}, 0.05);
  EXPECT_FALSE(chosen.holds_frames);
  EXPECT_THAT(chosen.sentences[1], testing::HasSubstr("60 frames a second do not hold (55.6 would)"));
}

TEST(Recommendation, TakesAnotherBackendForRunnerUpWhereThereIsNoOtherIntegrator) {
  const std::vector<WorkPoint> points{made_point("verlet", 1e-4, 0.3, 5e-4),
                                      made_point("verlet", 1e-4, 3, 5e-4, "serial")};
  const Recommendation chosen = recommend(points, {60, 1e-3}, 0.05);
  EXPECT_EQ(chosen.runner_up, 1U);
  EXPECT_THAT(chosen.sentences[2], testing::HasSubstr("cheaper at no error"));
}

TEST(Recommendation, NamesTheNearestWhereNothingIsAccurateEnough) {
  const std::vector<WorkPoint> points{made_point("semi-euler", 1e-4, 0.2, 2e-3),
                                      made_point("verlet", 1e-4, 0.9, 1e-3)};
  const Recommendation chosen = recommend(points, {60, 1e-4}, 0.05);
  EXPECT_FALSE(chosen.best);
  EXPECT_EQ(chosen.nearest, 1U);
  ASSERT_EQ(chosen.sentences.size(), 3U);
  EXPECT_THAT(chosen.sentences[0],
              testing::HasSubstr("Nothing that was measured keeps the error within 0.0001"));
}

TEST(Recommendation, SaysThatEverythingDiverged) {
  const Recommendation chosen =
      recommend(std::vector{diverged(made_point("rk4", 4e-4, 0.1, 1))}, {60, 1}, 0.05);
  EXPECT_FALSE(chosen.best || chosen.nearest || chosen.runner_up);
  EXPECT_EQ(chosen.sentences.size(), 1U);
}

}  // namespace
}  // namespace mssim
