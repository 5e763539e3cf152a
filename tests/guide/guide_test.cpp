#include "guide/guide.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "integrators/all_integrators.h"
#include "tests/support/systems.h"

namespace mssim {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

/// A point that counts. `cost`: wall seconds a simulated second.
WorkPoint made_point(std::string_view integrator, double dt_s, double cost, double error,
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
      ElementsAre(AllOf(HasSubstr("takes 1.00, 2.00 and 4.00 ms"), HasSubstr("takes 10.0, 5.00 and 2.00 s"),
                        EndsWith("rk4 is the cheapest."))));
  EXPECT_THAT(
      beside_the_paper(guide_of({made_point("semi-euler", 1e-3, 1, 1e-3), made_point("rk4", 1e-3, 4, 1e-4)})),
      ElementsAre(EndsWith("the order is the same.")));
  EXPECT_THAT(
      beside_the_paper(guide_of({made_point("semi-euler", 1e-3, 1, 1e-2), made_point("rk4", 1e-3, 4, 1e-4)})),
      ElementsAre(EndsWith("4.00 s with rk4, and semi-euler did not reach it: rk4 is the cheapest.")));
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
  EXPECT_THAT(front_of(points), ElementsAre(0, 1, 4));
}

TEST(ParetoFront, LeavesOutWhatDoesNotCount) {
  EXPECT_THAT(
      front_of({diverged(made_point("rk4", 1e-3, 0.1, 1e-9)),
                beyond_trust(made_point("rk4", 1e-3, 0.2, 1e-9)), made_point("verlet", 1e-3, 1, 1e-3)}),
      ElementsAre(2));
  EXPECT_THAT(front_of({}), testing::IsEmpty());
}

TEST(ParetoFront, KeepsEqualPoints) {
  EXPECT_THAT(front_of({made_point("rk4", 1e-3, 1, 1e-3), made_point("verlet", 1e-3, 1, 1e-3)}),
              ElementsAre(0, 1));
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
  ASSERT_EQ(chosen.sentences.size(), 3U);
  EXPECT_THAT(chosen.sentences[0], HasSubstr("Take verlet on openmp with a step of 0.0001 s"));
  EXPECT_THAT(chosen.sentences[0], HasSubstr("167 steps a frame"));
  EXPECT_THAT(chosen.sentences[1], HasSubstr("60 frames a second hold"));
  EXPECT_THAT(chosen.sentences[2], HasSubstr("runner-up is rk4 on openmp"));
  EXPECT_THAT(chosen.sentences[2], HasSubstr("it would win at errors of 1e-06 to below 0.0005."));
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

TEST(Recommendation, SaysForWhichErrorsTheRunnerUpIsCheaper) {
  // At 5e-4, say, the winner's own error, it is not.
  EXPECT_THAT(runner_up_sentence(by_turns),
              EndsWith("it would win at errors of 1e-06 to below 1e-05, 0.0001 to below 0.0005 and "
                       "0.005 to below 0.02."));
  std::vector<WorkPoint> many = by_turns;
  many.push_back(made_point("rk4", 2e-3, 0.01, 5e-2));
  EXPECT_THAT(runner_up_sentence(many), EndsWith("0.005 to below 0.02 and some larger ones."));
  EXPECT_THAT(runner_up_sentence({made_point("rk4", 1e-4, 2, 1e-4), made_point("verlet", 1e-4, 0.3, 1e-4),
                                  made_point("rk4", 1e-3, 0.1, 5e-3)}),
              EndsWith("it would win at errors of 0.005 or more."));
  EXPECT_THAT(
      runner_up_sentence({made_point("rk4", 1e-4, 0.5, 1e-4), made_point("verlet", 1e-4, 0.3, 1.001e-4)}),
      EndsWith("it would win at errors of about 0.0001."));
}

TEST(Recommendation, SaysWhereAFrameTakesTooLong) {
  const Recommendation chosen =
      recommend(std::vector{made_point("verlet", 1e-4, 3, 5e-4)}, {120, 1e-3}, 0.05);
  EXPECT_EQ(chosen.best, 0U);
  EXPECT_THAT(chosen.sentences[1], HasSubstr("120 frames a second do not hold"));
  EXPECT_THAT(chosen.sentences[2], HasSubstr("No other method"));
}

TEST(Recommendation, CountsWholeStepsForTheTimeOfAFrame) {
  // 60 frames a second have 2.5 steps of 1/150 s each, so that 3 are taken. At 6 ms a step these take 18
  // ms, 55.6 frames a second; 2.5 would take 15 ms, and a frame lasts 16.7 ms.
  const Recommendation chosen =
      recommend(std::vector{made_point("verlet", 1.0 / 150, 0.9, 5e-4)}, {60, 1e-3}, 0.05);
  EXPECT_THAT(chosen.sentences[1], HasSubstr("60 frames a second do not hold (55.6 would)"));
}

TEST(Recommendation, TakesAnotherBackendForRunnerUpWhereThereIsNoOtherIntegrator) {
  const std::vector<WorkPoint> points{made_point("verlet", 1e-4, 0.3, 5e-4),
                                      made_point("verlet", 1e-4, 3, 5e-4, "serial")};
  const Recommendation chosen = recommend(points, {60, 1e-3}, 0.05);
  EXPECT_EQ(chosen.runner_up, 1U);
  EXPECT_THAT(chosen.sentences[2], HasSubstr("cheaper at no error"));
}

TEST(Recommendation, NamesTheNearestWhereNothingIsAccurateEnough) {
  const std::vector<WorkPoint> points{made_point("semi-euler", 1e-4, 0.2, 2e-3),
                                      made_point("verlet", 1e-4, 0.9, 1e-3)};
  const Recommendation chosen = recommend(points, {60, 1e-4}, 0.05);
  EXPECT_FALSE(chosen.best);
  EXPECT_EQ(chosen.nearest, 1U);
  ASSERT_EQ(chosen.sentences.size(), 3U);
  EXPECT_THAT(chosen.sentences[0], HasSubstr("Nothing that was measured keeps the error within 0.0001"));
}

TEST(Recommendation, SaysThatEverythingDiverged) {
  const Recommendation chosen =
      recommend(std::vector{diverged(made_point("rk4", 4e-4, 0.1, 1))}, {60, 1}, 0.05);
  EXPECT_FALSE(chosen.best || chosen.nearest || chosen.runner_up);
  EXPECT_EQ(chosen.sentences.size(), 1U);
}

SizeCurve size_curve(std::vector<SizeCurve::Sample> samples, double dt_s = 1.0 / 600) {
  SizeCurve curve;
  curve.integrator = find_integrator("verlet");
  curve.backend = find_backend("serial");
  curve.dt_s = dt_s;
  curve.samples = std::move(samples);
  return curve;
}

TEST(ClothSizes, LargestIsBetweenTheLastThatHoldsAndTheNext) {
  // 10 steps a frame at 60 frames a second: a step may take 1/600 s. The time is that of the nodes.
  const SizeCurve curve = size_curve({{100, 1e-4}, {1000, 1e-3}, {10000, 1e-2}});
  ASSERT_TRUE(curve.largest(60));
  EXPECT_NEAR(curve.largest(60)->nodes, 1e3 / 0.6, 1);
  EXPECT_FALSE(curve.largest(60)->at_least);
}

TEST(ClothSizes, LargestIsThatOfWholeStepsAFrame) {
  // 3 steps a frame and not 2.5: a step may take 1/180 s.
  EXPECT_NEAR(size_curve({{100, 1e-3}, {1000, 1e-2}}, 1.0 / 150).largest(60)->nodes, 1e5 / 180, 1e-6);
}

TEST(ClothSizes, LargestMayBeBeyondOrBelowWhatWasMeasured) {
  EXPECT_FALSE(size_curve({}).largest(60));
  EXPECT_EQ(size_curve({{100, 1}, {1000, 10}}).largest(60)->nodes, 0);
  const auto large = size_curve({{100, 1e-6}, {1000, 1e-5}}).largest(60);
  EXPECT_EQ(large->nodes, 1000);
  EXPECT_TRUE(large->at_least);
}

TEST(ClothSizes, BackendsChangePlacesWhereTheirTimesAreEqual) {
  const SizeCurve slow_start = size_curve({{100, 1e-3}, {1000, 1e-3}, {10000, 2e-3}});
  const SizeCurve quick_start = size_curve({{100, 1e-4}, {1000, 1e-3}, {10000, 1e-2}});
  ASSERT_TRUE(crossover(slow_start, quick_start));
  EXPECT_NEAR(*crossover(slow_start, quick_start), 1000, 1e-6);
  EXPECT_NEAR(*crossover(quick_start, slow_start), 1000, 1e-6);
  EXPECT_FALSE(crossover(quick_start, quick_start));
}

TEST(ClothSizes, AreMeasuredUntilAFrameTakesTooLong) {
  // A step so small that no cloth holds 30 frames a second: two sizes show it.
  std::vector<SizeCurve> curves{size_curve({}, 1e-9), size_curve({}, 1e-9)};
  curves[1].status = "left out";
  measure_sizes(
      curves, [](std::uint32_t side) { return FamilyCloth{cloth_system(side, side)}; }, {.threads = 1},
      [](const std::string&, double) { return true; });
  ASSERT_EQ(curves[0].samples.size(), 2U);
  EXPECT_EQ(curves[0].samples[0].nodes, 256U);
  EXPECT_EQ(curves[0].largest(30)->nodes, 0);
  EXPECT_TRUE(curves[1].samples.empty());
}

TEST(ClothSizes, SayThatTheTimeWasOver) {
  std::vector<SizeCurve> curves{size_curve({})};
  measure_sizes(
      curves, [](std::uint32_t side) { return FamilyCloth{cloth_system(side, side)}; }, {.threads = 1},
      [](const std::string&, double) { return false; });
  EXPECT_TRUE(curves[0].samples.empty());
  EXPECT_NE(curves[0].status, "");
}

}  // namespace
}  // namespace mssim
