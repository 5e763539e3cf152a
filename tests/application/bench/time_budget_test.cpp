#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <thread>

#include "application/bench/bench_run.h"
#include "text/error.h"

namespace mssim {
namespace {

using Clock = TimeBudget::Clock;

double seconds_until(const std::optional<Clock::time_point>& when) {
  return std::chrono::duration<double>(when.value() - Clock::now()).count();
}

TEST(TimeBudget, IsNoLimitWithoutSeconds) {
  TimeBudget budget(std::nullopt, {{1000, 1000}});
  EXPECT_EQ(budget.begin_scene(), std::nullopt);
}

TEST(TimeBudget, GivesAllScenesAsManyRounds) {
  TimeBudget budget(100, {{10, 1}, {30, 3}});
  // 60 seconds are left for rounds of 1 + 3 seconds: 15 each.
  EXPECT_NEAR(seconds_until(budget.begin_scene()), 10 + 15 * 1, 0.5);
}

TEST(TimeBudget, GivesTheLastSceneAllThatIsLeft) {
  TimeBudget budget(50, {{10, 1}, {10, 1}});
  budget.begin_scene();
  EXPECT_NEAR(seconds_until(budget.begin_scene()), 50, 0.5);
}

TEST(TimeBudget, BelievesWhatTheFirstRoundsTook) {
  TimeBudget budget(10, {{0.01, 0.01}, {0.01, 0.01}, {0.01, 0.02}});
  budget.begin_scene();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // at least ten times what was expected
  budget.first_round_done();
  // Of 9.8 seconds 0.2 at least are for preparing two scenes; of the rest this scene has a third.
  const double seconds = seconds_until(budget.begin_scene());
  EXPECT_GT(seconds, 3);
  EXPECT_LT(seconds, 3.4);
}

TEST(TimeBudget, IsRefusedWhereItIsTooShortForARoundOfEach) {
  EXPECT_THROW(TimeBudget(43, {{10, 1}, {30, 3}}), UsageError);
  EXPECT_NO_THROW(TimeBudget(44, {{10, 1}, {30, 3}}));
}

}  // namespace
}  // namespace mssim
