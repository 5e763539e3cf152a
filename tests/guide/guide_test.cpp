#include "guide/guide.h"

#include "guide/ranking.h"
#include "integrators/all_integrators.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// A point and its method.
struct MadePoint : WorkPoint {
  const Integrator* integrator = nullptr;
  const BackendInfo* backend = nullptr;
};

/// A point that counts. `cost`: wall seconds a simulated second.
MadePoint made_point(std::string_view integrator, double dt_s, double cost, double error,
                     std::string_view backend = "openmp") {
  MadePoint point;
  point.integrator = find_integrator(integrator);
  point.backend = find_backend(backend);
  point.dt_s = dt_s;
  point.seconds_a_step = cost * dt_s;
  point.position_error = error;
  point.energy_error = 0;
  return point;
}

/// With the methods of the points, in the order of their first ones.
SceneGuide guide_of(const std::vector<MadePoint>& points) {
  SceneGuide guide;
  guide.wish.error = 1e-3;
  guide.trusted.horizon_s = 0.05;
  for (const MadePoint& point : points) {
    auto its = std::ranges::find_if(guide.methods, [&](const GuidedMethod& method) {
      return method.integrator == point.integrator && method.backend == point.backend;
    });
    if (its == guide.methods.end()) its = guide.methods.insert(its, {point.integrator, point.backend});
    its->points.push_back(point);
  }
  return guide;
}

TEST(CostAtError, IsALineThroughTheLogarithms) {
  const SceneGuide guide =
      guide_of({made_point("rk4", 4e-4, 1, 1e-2), made_point("rk4", 2e-4, 2, 1e-4),
                made_point("verlet", 2e-4, 0.1, 1e-6), made_point("rk4", 2e-4, 0.1, 1e-6, "serial")});
  const GuidedMethod& rk4 = guide.methods[0];
  const auto cost = cost_at_error(rk4, 1e-3);
  ASSERT_TRUE(cost);
  EXPECT_NEAR(cost->seconds_a_second, std::sqrt(2), 1e-9);
  EXPECT_NEAR(cost->dt_s, 2e-4 * std::sqrt(2), 1e-12);
  EXPECT_FALSE(cost->at_longest_step);
  // No longer step than the coarsest, no smaller error than the finest.
  EXPECT_NEAR(cost_at_error(rk4, 1)->seconds_a_second, 1, 1e-12);
  EXPECT_TRUE(cost_at_error(rk4, 1)->at_longest_step);
  EXPECT_FALSE(cost_at_error(rk4, 0.9e-4));
  EXPECT_FALSE(cost_at_error({find_integrator("rk4"), find_backend("openmp")}, 1)) << "no points";
}

TEST(CostAtError, LeavesOutWhatDoesNotCount) {
  SceneGuide guide = guide_of({made_point("rk4", 4e-4, 1, 1e-3), made_point("rk4", 2e-4, 2, 1e-4)});
  guide.methods[0].points.front().diverged = true;
  const auto cost = cost_at_error(guide.methods[0], 1e-3);
  ASSERT_TRUE(cost);
  EXPECT_NEAR(cost->seconds_a_second, 2, 1e-12);
  EXPECT_TRUE(cost->at_longest_step);
}

TEST(CostAtError, IsThatOfTheLongestStepThatKeepsTheError) {
  // A shorter step is off by more, and one that was measured last is longer than one that was first.
  const SceneGuide guide = guide_of(
      {made_point("rk4", 1e-4, 4, 2e-3), made_point("rk4", 2e-4, 2, 5e-4), made_point("rk4", 4e-4, 1, 8e-3)});
  const GuidedMethod& rk4 = guide.methods[0];
  // log(8) of log(16): three quarters of the way.
  EXPECT_NEAR(cost_at_error(rk4, 1e-3)->seconds_a_second, std::pow(2, 0.75), 1e-9);
  EXPECT_NEAR(cost_at_error(rk4, 1e-3)->dt_s, 4e-4 / std::pow(2, 0.75), 1e-12);
  EXPECT_EQ(point_at_error(rk4, 1e-3), &rk4.points[1]);
  EXPECT_EQ(point_at_error(rk4, 3e-3), &rk4.points[1]);
  EXPECT_EQ(point_at_error(rk4, 1e-2), &rk4.points[2]);
  EXPECT_FALSE(point_at_error(rk4, 1e-4));
}

Recommendation recommend_from(const std::vector<MadePoint>& points, Wish wish = {60, 1e-3}) {
  SceneGuide guide = guide_of(points);
  guide.wish = wish;
  return recommend(guide);
}

void add_limit(SceneGuide& guide, std::string_view name, double stable_s) {
  StepLimit limit;
  limit.integrator = find_integrator(name);
  limit.measured = {.stable_s = stable_s, .unstable_s = 1.01 * stable_s};
  guide.limits.push_back(limit);
}

TEST(BesideThePaper, SaysWhatBecomesOfTheOrder) {
  // A step takes 1, 2 and 4 ms.
  EXPECT_THAT(
      beside_the_paper(guide_of({made_point("semi-euler", 1e-4, 10, 1e-3),
                                 made_point("midpoint", 4e-4, 5, 1e-3), made_point("rk4", 2e-3, 2, 1e-3)})),
      ElementsAre(AllOf(HasSubstr("take 1.00, 2.00 and 4.00 ms"), HasSubstr("takes 10.0, 5.00 and 2.00 s"),
                        EndsWith("rk4 is the cheapest."))));
  EXPECT_THAT(
      beside_the_paper(guide_of({made_point("semi-euler", 1e-3, 1, 1e-3), made_point("rk4", 1e-3, 4, 1e-4)})),
      ElementsAre(EndsWith("the order is the same.")));
  EXPECT_THAT(
      beside_the_paper(guide_of({made_point("semi-euler", 1e-3, 1, 1e-2), made_point("rk4", 1e-3, 4, 1e-4)})),
      ElementsAre(EndsWith("4.00 s with rk4, and semi-euler did not reach it: rk4 is the cheapest.")));
  EXPECT_THAT(beside_the_paper(guide_of({made_point("semi-euler", 1e-3, 1, 1e-2)})), IsEmpty());
}

TEST(BesideThePaper, SaysHowExplicitEulerStands) {
  SceneGuide guide =
      guide_of({made_point("explicit-euler", 1e-4, 10, 1e-3), made_point("verlet", 4e-4, 2, 1e-3)});
  add_limit(guide, "explicit-euler", 1e-4);
  add_limit(guide, "semi-euler", 4e-4);
  EXPECT_THAT(
      beside_the_paper(guide),
      ElementsAre(
          "explicit-euler was stable with 0.250 of semi-euler's largest step, and takes 5.00 times as "
          "long as the cheapest method at an error of 0.001."));
}

MadePoint diverged(MadePoint point) {
  point.diverged = true;
  return point;
}

MadePoint beyond_trust(MadePoint point) {
  point.beyond_trust = true;
  return point;
}

/// The numbers of the points on the front. Points of a method follow each other.
std::vector<std::size_t> front_of(const std::vector<MadePoint>& points) {
  SceneGuide guide = guide_of(points);
  mark_pareto_front(guide.methods);
  std::vector<std::size_t> front;
  std::size_t number = 0;
  for (const GuidedMethod& method : guide.methods)
    for (const WorkPoint& point : method.points) {
      if (point.on_front) front.push_back(number);
      ++number;
    }
  return front;
}

TEST(ParetoFront, HasWhatNothingBeats) {
  const std::vector<MadePoint> points{
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
  EXPECT_THAT(front_of({}), IsEmpty());
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
  const std::vector<MadePoint> points{
      made_point("semi-euler", 1e-4, 0.2, 2e-3), made_point("verlet", 1e-4, 0.3, 5e-4),
      made_point("verlet", 5e-5, 0.6, 1e-4),     made_point("verlet", 1e-4, 3, 5e-4, "serial"),
      made_point("rk4", 2e-4, 0.5, 1e-6),        diverged(made_point("rk4", 4e-4, 0.1, 1e-9)),
  };
  const Recommendation chosen = recommend_from(points);
  EXPECT_EQ(chosen.best, 1U);
  EXPECT_EQ(chosen.runner_up, 3U);  // of another integrator
  ASSERT_EQ(chosen.sentences.size(), 3U);
  EXPECT_THAT(chosen.sentences[0], HasSubstr("Take verlet on openmp with a step of 0.0001 s"));
  EXPECT_THAT(chosen.sentences[0], HasSubstr("167 steps per frame"));
  EXPECT_THAT(chosen.sentences[1], HasSubstr("fast enough for 60 frames per second"));
  EXPECT_THAT(chosen.sentences[2], HasSubstr("runner-up is rk4 on openmp"));
  EXPECT_THAT(chosen.sentences[2], EndsWith("errors of 1e-06 to below 0.00015."));
}

TEST(Recommendation, ComparesAStepWithTheLongestStableOneUnlessTheHorizonLimitsIt) {
  for (const auto& [horizon_s, is_longest] : {std::pair{1e-2, true}, {1e-4, false}}) {
    SceneGuide guide = guide_of({made_point("verlet", 1e-4, 1, 5e-4)});
    guide.wish = {60, 1e-3};
    guide.trusted.horizon_s = horizon_s;
    add_limit(guide, "verlet", 1.1e-4);
    EXPECT_EQ(
        recommend(guide).sentences.at(0).find("0.91 of the longest that is stable") != std::string::npos,
        is_longest)
        << horizon_s;
  }
}

std::string runner_up_sentence(const std::vector<MadePoint>& points) {
  return recommend_from(points).sentences.at(2);
}

TEST(Recommendation, ComparesAtEqualError) {
  // At 1e-3 verlet takes sqrt(2) s, halfway between its points, and rk4, with its longest step, 1.8 s. Of
  // their points within 1e-3 rk4 has the cheaper one.
  const std::vector<MadePoint> points{made_point("verlet", 2e-4, 1, 2e-3),
                                      made_point("verlet", 1e-4, 2, 5e-4),
                                      made_point("rk4", 4e-4, 1.8, 9e-4)};
  const Recommendation chosen = recommend_from(points);
  EXPECT_EQ(chosen.best, 0U);
  EXPECT_EQ(chosen.runner_up, 1U);
  EXPECT_THAT(chosen.sentences.at(0), HasSubstr("verlet on openmp with a step of 0.0001 s"));
  EXPECT_THAT(chosen.sentences.at(2), HasSubstr("rk4 on openmp with a step of 0.0004 s"));
  EXPECT_THAT(chosen.sentences.at(2), HasSubstr("1.27 times as long at an error of 0.001"));
  EXPECT_THAT(chosen.sentences.at(2), HasSubstr("cheaper at no error"));
}

TEST(Recommendation, SaysForWhichErrorsTheRunnerUpIsCheaper) {
  // Only rk4 keeps 1e-6 to 1e-5. From there on verlet is cheaper, until rk4 comes down from 4 s at 1e-3 to
  // the 1 s that verlet takes with its longest step: log(4) of log(8), two thirds of the two decades up to
  // 0.1.
  const std::vector<MadePoint> by_turns{
      made_point("rk4", 1e-5, 8, 1e-6),      made_point("rk4", 2e-5, 5, 1e-4),
      made_point("rk4", 1e-4, 4, 1e-3),      made_point("rk4", 2e-4, 0.5, 0.1),
      made_point("verlet", 1e-5, 4.5, 1e-5), made_point("verlet", 2e-5, 4, 1e-4),
      made_point("verlet", 1e-4, 1, 1e-3),
  };
  EXPECT_THAT(runner_up_sentence(by_turns), EndsWith("errors of 1e-06 to below 1e-05 and 0.022 or more."));
  EXPECT_THAT(
      runner_up_sentence({made_point("rk4", 1e-4, 0.5, 1e-4), made_point("verlet", 1e-4, 0.3, 1.001e-4)}),
      EndsWith("errors of about 0.0001."));
  // Both have the same two errors. rk4 takes half as long at the smaller one and five times as long at the
  // larger one: they meet at log(2) of log(10) of the way.
  EXPECT_THAT(
      runner_up_sentence({made_point("rk4", 1e-5, 1, 1e-5), made_point("rk4", 1e-4, 0.5, 1e-3),
                          made_point("verlet", 1e-5, 2, 1e-5), made_point("verlet", 1e-4, 0.1, 1e-3)}),
      EndsWith("at errors of 1e-05 to below 4e-05."));
}

SceneGuide between_two_steps() {
  SceneGuide guide = guide_of({made_point("verlet", 2e-4, 1, 2e-3), made_point("verlet", 1e-4, 2, 5e-4)});
  guide.trusted.horizon_s = 0.01;
  guide.methods[0].points[0].steps = 50;
  guide.methods[0].points[1].steps = 100;
  return guide;
}

TEST(LongestStep, IsWhereTheCurveComesToTheError) {
  SceneGuide guide = between_two_steps();
  GuidedMethod& verlet = guide.methods.front();
  const auto add = [&](int steps, double error) {
    verlet.points.push_back(made_point("verlet", 0.01 / steps, 0.02 * steps, error));
    verlet.points.back().steps = steps;
  };
  EXPECT_EQ(steps_to_try(guide, verlet), 71);  // of sqrt(2) * 1e-4 s, 70.7
  add(71, 1.1e-3);                             // which is off by a little more than the curve says
  EXPECT_EQ(steps_to_try(guide, verlet), 75);  // 74.001
  add(75, 9.9e-4);
  EXPECT_EQ(steps_to_try(guide, verlet), std::nullopt);
  EXPECT_EQ(point_at_error(verlet, guide.wish.error), &verlet.points[3]);
  EXPECT_THAT(recommend(guide).sentences.at(0), HasSubstr("0.00013 s"));  // 0.01 s / 75
  guide.wish.error = 1e-4;
  EXPECT_EQ(steps_to_try(guide, verlet), std::nullopt) << "nothing keeps it";
}

TEST(LongestStep, IsThatOfLargerClothsForEveryMethod) {
  SceneGuide guide = between_two_steps();
  GuidedMethod& verlet = guide.methods.front();
  EXPECT_NEAR(step_for_sizes(guide, verlet), 1e-4 * std::sqrt(2), 1e-12);
  guide.wish.error = 1e-4;  // which nothing keeps: of the cheapest point
  EXPECT_EQ(step_for_sizes(guide, verlet), 2e-4);
  verlet.points[0].diverged = true;
  EXPECT_EQ(step_for_sizes(guide, verlet), 1e-4);
  verlet.points[1].within_limit = false;
  EXPECT_EQ(step_for_sizes(guide, verlet), 0);
}

TEST(LongestStep, IsBoundedByStability) {
  SceneGuide guide = between_two_steps();
  GuidedMethod& verlet = guide.methods.front();
  guide.wish.error = 1e-2;
  add_limit(guide, "verlet", 4e-4);
  EXPECT_EQ(steps_to_try(guide, verlet), 27);  // 0.01 s / (0.95 * 4e-4 s) = 26.3
  EXPECT_THAT(recommend(guide).sentences.at(0), AllOf(HasSubstr("0.00037 s"), Not(HasSubstr("stable"))));
  guide.limits[0].measured.stable_s = 2e-4;  // not longer than what was measured
  EXPECT_EQ(steps_to_try(guide, verlet), std::nullopt);
  EXPECT_THAT(recommend(guide).sentences.at(0), AllOf(HasSubstr("0.0002 s"), HasSubstr("stable")));
  guide.limits[0].measured.stable_s = 4e-4;
  verlet.points.push_back(made_point("verlet", 0.01 / 30, 0.5, 1));
  verlet.points.back().steps = 30;
  verlet.points.back().diverged = true;
  EXPECT_EQ(steps_to_try(guide, verlet), std::nullopt) << "a step between the two diverged";
}

/// verlet takes 0.3 s at the wished error, with a step of 1e-4 s; of rk4 one point was measured, or none, and
/// then the time was over.
SceneGuide with_unfinished(const std::optional<MadePoint>& point, double step_seconds) {
  std::vector<MadePoint> points{made_point("verlet", 1e-4, 0.3, 1e-3)};
  if (point) points.push_back(*point);
  SceneGuide guide = guide_of(points);
  if (!point) guide.methods.push_back({find_integrator("rk4"), find_backend("openmp")});
  guide.methods.back().ending.lack = Lack::time;
  guide.methods.back().step_seconds = step_seconds;
  return guide;
}

/// Of order 4: a sixteenth of the error, 1e-3, with half the step, 2e-4 s.
MadePoint coarse_rk4() { return made_point("rk4", 4e-4, 0.1, 1.6e-2); }

TEST(MissedMethods, AreThoseThatCouldBeTheCheapest) {
  const MadePoint coarse = coarse_rk4();
  const auto missed = [](const SceneGuide& guide) { return missed_methods(guide).size(); };
  EXPECT_EQ(missed(with_unfinished(coarse, 1.01 * 0.3 * 2e-4)), 0U);
  EXPECT_EQ(missed(with_unfinished(coarse, 0.99 * 0.3 * 2e-4)), 1U);
  SceneGuide guide = with_unfinished(coarse, 0.99 * 0.3 * 2e-4);
  guide.methods.back().ending.lack = Lack::nothing;
  EXPECT_EQ(missed(guide), 0U) << "more time would not help";
  guide.methods.back().ending.lack = Lack::time;
  GuidedMethod on_serial{find_integrator("rk4"), find_backend("serial")};
  on_serial.points.push_back(made_point("rk4", 1e-4, 1, 1.1e-3));
  guide.methods.insert(guide.methods.begin(), on_serial);
  EXPECT_EQ(missed(guide), 0U) << "its integrator comes to its end short of the error";
  // No step is longer than the longest usable one: 0.95 * 1e-4 s takes longer.
  guide = with_unfinished(coarse, 0.99 * 0.3 * 2e-4);
  add_limit(guide, "rk4", 1e-4);
  EXPECT_EQ(missed(guide), 0U);
  // Without a point it may be that one, and without that, or without a time, nothing is known.
  guide = with_unfinished({}, 0.99 * 0.3 * 0.95e-4);
  EXPECT_EQ(missed(guide), 1U);
  add_limit(guide, "rk4", 1e-4);
  EXPECT_EQ(missed(guide), 1U);
  guide.methods.back().step_seconds = 1.01 * 0.3 * 0.95e-4;
  EXPECT_EQ(missed(guide), 0U);
  guide.methods.back().step_seconds = 0;
  EXPECT_EQ(missed(guide), 1U);
  guide.methods.back().integrator = find_integrator("xpbd");
  EXPECT_EQ(missed(guide), 0U) << "it is implicit";
  guide.methods.front().points.clear();
  EXPECT_EQ(missed(guide), 1U) << "nothing else was measured";
  guide.methods.front().ending.lack = Lack::time;
  EXPECT_EQ(missed_methods(guide), std::vector<const GuidedMethod*>{&guide.methods.front()});
}

TEST(MissedMethods, MayLackTheReferencesTime) {
  SceneGuide guide = guide_of({beyond_trust(made_point("verlet", 1e-4, 0.3, 1e-9))});
  guide.methods.back().step_seconds = 3e-5;
  EXPECT_EQ(missed_methods(guide).size(), 0U);
  guide.trusted.short_of_s = 30;
  EXPECT_EQ(missed_methods(guide).size(), 1U);
  // Of which a guide has a fifth.
  EXPECT_DOUBLE_EQ(*recommend(guide).needed_s, 150);
}

TEST(NeededTime, IsThatOfTheCurvesThatAreMissed) {
  // rk4 needs a step of 2e-4 s, of which its points of 3.2e-4, 1.6e-4 s are left: 2 s and 4 s. The curve of
  // serial would have had one of 3 s meanwhile, and no more. With 10 s for those that there are that is 19 s,
  // of which a guide has 0.3.
  SceneGuide guide = with_unfinished(made_point("rk4", 4e-4, 0.1, 1.6e-2), 0.99 * 0.3 * 2e-4);
  guide.seconds = 5;
  guide.seconds_on_points = 10;
  guide.methods.back().next = NextPoint{2, 3.2e-4, 10};
  guide.methods.push_back({find_integrator("xpbd"), find_backend("serial")});
  guide.methods.back().ending.lack = Lack::time;
  guide.methods.back().next = NextPoint{3, 1e-3, 10};
  const Recommendation chosen = recommend(guide);
  EXPECT_EQ(chosen.needed_s, 64);  // 63.3
  EXPECT_FALSE(chosen.best || chosen.runner_up || chosen.nearest);
  ASSERT_EQ(chosen.sentences.size(), 1U);
  for (const char* text : {"Nothing is recommended", "5 s", "rk4 on openmp", "64 s", "--time-budget"})
    EXPECT_THAT(chosen.sentences[0], HasSubstr(text));
  guide.seconds = 40;
  EXPECT_EQ(recommend(guide).needed_s, 80) << "twice what was too little, at least";
}

TEST(NeededTime, IsThatOfThePointsThatACurveMayHave) {
  SceneGuide guide = with_unfinished(coarse_rk4(), 0.99 * 0.3 * 2e-4);
  guide.seconds = 1;
  guide.seconds_on_points = 9;
  // Of the points of 3.2e-4 and 1.6e-4 s the second would be the twelfth: 9 s and 3 s, of which a guide has
  // 0.3. The curve of serial may have points of 1 s and 2 s.
  guide.methods.back().next = NextPoint{3, 3.2e-4, 0};
  EXPECT_EQ(recommend(guide).needed_s, 40);
  guide.methods.push_back({find_integrator("xpbd"), find_backend("serial")});
  guide.methods.back().ending.lack = Lack::time;
  guide.methods.back().next = NextPoint{1, 1e-3, 10};
  EXPECT_EQ(recommend(guide).needed_s, 50);
  guide.methods.back().next = NextPoint{0.25, 1e-3, 1};  // and 0.5 s, but not 1 s and 2 s
  EXPECT_EQ(recommend(guide).needed_s, 43);              // 42.5
}

TEST(NeededTime, PromisesNothingWhereTimeEndedTheHorizon) {
  SceneGuide guide = with_unfinished(coarse_rk4(), 0.99 * 0.3 * 2e-4);
  guide.seconds = 5;
  EXPECT_THAT(recommend(guide).sentences, ElementsAre(HasSubstr("About 10 s for this scene would suffice")));
  guide.trusted.short_of_s = 1;
  EXPECT_THAT(recommend(guide).sentences, ElementsAre(HasSubstr("About 10 s for this scene may be needed")));
}

TEST(NeededTime, IsThatOfALimitThatWasNotFound) {
  SceneGuide guide = with_unfinished({}, 0);
  add_limit(guide, "rk4", 0);
  guide.limits[0].measured.finished = false;
  guide.limits[0].step_seconds = 0.01;
  guide.limits.emplace_back().integrator = find_integrator("verlet");
  // Eight runs of ten steps, for two integrators, in a fifth of the time.
  EXPECT_DOUBLE_EQ(*recommend(guide).needed_s, 8);
}

TEST(NeededTime, IsThatOfAReference) {
  SceneGuide guide;
  guide.seconds = 5;
  guide.trusted.failure = "no time is left";
  guide.trusted.short_of_s = 30;
  EXPECT_DOUBLE_EQ(*recommend(guide).needed_s, 150);
  guide.trusted.short_of_s = 0;  // another failure
  EXPECT_FALSE(recommend(guide).needed_s);
}

TEST(NeededTime, IsNotKnownToAGuideThatWasStopped) {
  SceneGuide guide = with_unfinished(made_point("rk4", 4e-4, 0.1, 1.6e-2), 0.99 * 0.3 * 2e-4);
  guide.seconds = 5;
  guide.stopped = true;
  const Recommendation chosen = recommend(guide);
  EXPECT_FALSE(chosen.needed_s || chosen.best || chosen.nearest);
  EXPECT_THAT(chosen.sentences, ElementsAre(AllOf(HasSubstr("stopped"), HasSubstr("rk4 on openmp"),
                                                  Not(HasSubstr("--time-budget")))));
}

/// semi-euler is off by 8.7e-4, and rk4 by less than 50 * 1.803e-7 = 9.015e-6.
SceneGuide beyond_the_reference() {
  SceneGuide guide =
      guide_of({made_point("semi-euler", 1e-4, 1, 8.7e-4), beyond_trust(made_point("rk4", 1e-4, 1, 6.2e-7))});
  guide.trusted.own_error = 1.803e-7;
  guide.wish.error = 1e-6;
  return guide;
}

TEST(Recommendation, SaysThatTheReferenceIsNotAccurateEnough) {
  SceneGuide guide = beyond_the_reference();
  Recommendation chosen = recommend(guide);
  EXPECT_FALSE(chosen.best || chosen.nearest || chosen.needed_s);
  EXPECT_THAT(chosen.sentences, ElementsAre(AllOf(HasSubstr("an error of 1e-06"), HasSubstr("reference"),
                                                  HasSubstr("--error 9.1e-06"))));
  EXPECT_THAT(
      what_was_measured(guide),
      ElementsAre(HasSubstr("1 of 2"), AllOf(HasSubstr("reference"), EndsWith(": rk4 on openmp.")),
                  AllOf(HasSubstr("Not within an error of 1e-06"), EndsWith(": semi-euler on openmp."))));
  // The curve of rk4 passes the error between two points, of which only one counts.
  guide.methods[1].points.push_back(made_point("rk4", 2e-4, 0.5, 2.03e-5));
  guide.wish.error = 1e-5;
  EXPECT_THAT(recommend(guide).sentences, ElementsAre(HasSubstr("--error 2.1e-05")));
}

TEST(Recommendation, KnowsThatLargeErrorsAreTooLarge) {
  SceneGuide guide = beyond_the_reference();
  guide.methods.pop_back();
  EXPECT_EQ(recommend(guide).nearest, 0U);
  EXPECT_THAT(recommend(guide).sentences.at(0), HasSubstr("No measured method keeps"));
  // Smaller steps could keep the error, but that would not show.
  guide.methods[0].ending.lack = Lack::time;
  EXPECT_FALSE(recommend(guide).needed_s || recommend(guide).nearest);
  EXPECT_THAT(recommend(guide).sentences, ElementsAre(HasSubstr("--error 9.1e-06")));
  guide.trusted.short_of_s = 1;  // with a better reference it could
  EXPECT_TRUE(recommend(guide).needed_s);
}

TEST(Recommendation, ShowsOnWhichSideOfTheWishedErrorANumberIs) {
  EXPECT_THAT(recommend_from({made_point("verlet", 1e-4, 0.9, 1.01e-3)}).sentences.at(1),
              HasSubstr("error of a node is 0.00101 of"));
  // rk4 takes 4 s to 1 s, and as long as verlet, 2 s, at the middle of 5e-4 and 2.016e-3: their
  // root, 1.00399e-3.
  EXPECT_THAT(
      runner_up_sentence({made_point("verlet", 1e-4, 2, 5e-4), made_point("rk4", 1e-4, 4, 5e-4),
                          made_point("rk4", 2e-4, 1, 2.016e-3)}),
      AllOf(HasSubstr("1.00 times as long at an error of 0.001;"), EndsWith("errors of 0.001004 or more.")));
}

TEST(WhatWasMeasured, SaysWhichMethodsWereNotAndWhy) {
  SceneGuide guide = guide_of({made_point("verlet", 1e-4, 1, 5e-4), made_point("rk4", 1e-4, 1, 5e-3)});
  const auto add = [&](const char* integrator, const char* backend, Lack lack) {
    guide.methods.push_back({find_integrator(integrator), find_backend(backend)});
    guide.methods.back().ending.lack = lack;
  };
  add("rk4", "serial", Lack::time);
  add("verlet", "serial", Lack::time);
  add("xpbd", "serial", Lack::unsupported);
  add("xpbd", "opencl", Lack::unavailable);
  add("explicit-euler", "serial", Lack::stable_step);
  EXPECT_THAT(what_was_measured(guide),
              ElementsAre(HasSubstr("2 of 7 methods"),
                          AllOf(HasSubstr("time"), EndsWith(": rk4 and verlet on serial.")),
                          EndsWith(": xpbd on serial and opencl."), EndsWith(": explicit-euler on serial."),
                          AllOf(HasSubstr("0.001"), EndsWith(": rk4 on openmp."))));
  guide.methods[1].ending.lack = Lack::time;
  EXPECT_THAT(what_was_measured(guide).back(), AllOf(HasSubstr("time"), EndsWith(": rk4 on openmp.")));
  guide.methods[4].ending = {Lack::not_timed, "too crowded"};
  guide.methods[5].ending = {Lack::failed, "it stumbled"};
  EXPECT_THAT(what_was_measured(guide),
              testing::IsSupersetOf({AllOf(HasSubstr("times mean nothing"), EndsWith(": xpbd on serial.")),
                                     AllOf(HasSubstr("fails"), EndsWith(": xpbd on opencl."))}));
}

TEST(Recommendation, SaysWhereAFrameTakesTooLong) {
  const Recommendation chosen = recommend_from({made_point("verlet", 1e-4, 3, 5e-4)}, {120, 1e-3});
  EXPECT_EQ(chosen.best, 0U);
  EXPECT_THAT(chosen.sentences[1], HasSubstr("too slow for 120 frames per second"));
  EXPECT_THAT(chosen.sentences[2], HasSubstr("No other"));
}

TEST(Recommendation, CountsWholeStepsForTheTimeOfAFrame) {
  // 60 frames a second have 2.5 steps of 1/150 s each, so that 3 are taken. At 6 ms a step these take 18
  // ms; 2.5 would take 15 ms, and a frame lasts 16.7 ms. At 50 frames a second, 3 steps are fast enough.
  const std::vector<MadePoint> points{made_point("verlet", 1.0 / 150, 0.9, 5e-4)};
  EXPECT_THAT(recommend_from(points).sentences[1], HasSubstr("too slow for 60 frames per second. "));
  EXPECT_THAT(recommend_from(points, {50, 1e-3}).sentences[1],
              HasSubstr("fast enough for 50 frames per second. "));
}

TEST(Recommendation, TakesAnotherBackendForRunnerUpWhereThereIsNoOtherIntegrator) {
  const std::vector<MadePoint> points{made_point("verlet", 1e-4, 0.3, 5e-4),
                                      made_point("verlet", 1e-4, 3, 5e-4, "serial")};
  const Recommendation chosen = recommend_from(points);
  EXPECT_EQ(chosen.runner_up, 1U);
  EXPECT_THAT(chosen.sentences[2], HasSubstr("cheaper at no error"));
}

TEST(Recommendation, NamesTheNearestWhereNothingIsAccurateEnough) {
  const std::vector<MadePoint> points{made_point("semi-euler", 1e-4, 0.2, 2e-3),
                                      made_point("verlet", 1e-4, 0.9, 1e-3)};
  const Recommendation chosen = recommend_from(points, {60, 1e-4});
  EXPECT_FALSE(chosen.best);
  EXPECT_EQ(chosen.nearest, 1U);
  ASSERT_EQ(chosen.sentences.size(), 2U);
  EXPECT_THAT(chosen.sentences[0], AllOf(HasSubstr("error within 1e-04 "), HasSubstr("verlet on openmp")));
}

TEST(Recommendation, SaysThatEverythingDiverged) {
  const Recommendation chosen = recommend_from({diverged(made_point("rk4", 4e-4, 0.1, 1))}, {60, 1});
  EXPECT_FALSE(chosen.best || chosen.nearest || chosen.runner_up);
  EXPECT_THAT(chosen.sentences, ElementsAre(HasSubstr("no measured point is stable")));
}

}  // namespace
}  // namespace mssim
