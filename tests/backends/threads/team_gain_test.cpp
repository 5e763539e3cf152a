#include "backends/threads/team_gain.h"

#include <gtest/gtest.h>

#include <chrono>

namespace mssim {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

/// A team whose time is made up, and ends before the present.
class Team {
 public:
  explicit Team(int threads = 2) : threads_(threads) { gain.begin(now_); }

  /// A phase in which each thread works for `work`, and the first to arrive then waits for the last.
  bool begins_alone_after(TeamGain::Duration work, TeamGain::Duration wait) {
    now_ += work + wait;
    gain.add_wait(wait);
    return gain.begins_alone(threads_, [&] { return now_; });
  }
  /// Phases of 10 us of work and that wait until one thread is to work alone; 0: never.
  int phases_until_alone(TeamGain::Duration wait) {
    for (int phase = 1; phase <= 10'000; ++phase)
      if (begins_alone_after(microseconds(10), wait)) return phase;
    return 0;
  }
  void work_well(int phases) {
    for (int i = 0; i < phases; ++i) EXPECT_FALSE(begins_alone_after(microseconds(10), microseconds(1)));
  }

  TeamGain gain;

 private:
  int threads_;
  TeamGain::Clock::time_point now_{};
};

TEST(TeamGain, KeepsATeamThatIsFasterThanOneThread) {
  Team team;
  EXPECT_EQ(team.phases_until_alone(microseconds(1)), 0);
  EXPECT_EQ(team.phases_until_alone(microseconds(9)), 0);
}

TEST(TeamGain, EndsATeamThatIsSlowerWhenItHasLostWhatItHadGained) {
  Team team;
  EXPECT_EQ(team.phases_until_alone(microseconds(20)), 151) << "10 us a phase, of 1.5 ms";
  EXPECT_EQ(team.phases_until_alone(microseconds(20)), 151) << "it starts again";
  team.work_well(10'000);
  EXPECT_EQ(team.phases_until_alone(microseconds(20)), 301) << "and remembers 3 ms";
}

TEST(TeamGain, CountsThreads) {
  Team team(8);
  EXPECT_FALSE(team.begins_alone_after(milliseconds(4), milliseconds(28)));
  EXPECT_TRUE(team.begins_alone_after(milliseconds(4), milliseconds(32)));
}

TEST(TeamGain, AsksForTheTimeAfterAWaitOnly) {
  TeamGain gain;
  EXPECT_FALSE(gain.begins_alone(2, [] {
    ADD_FAILURE() << "asked";
    return TeamGain::Clock::time_point{};
  }));
}

/// Lets a team of two lose by a wait. Whether one thread still works alone that long after it.
bool is_alone(TeamGain& gain, TeamGain::Duration wait, TeamGain::Duration after) {
  const TeamGain::Clock::time_point past = TeamGain::Clock::now() - after;
  gain.begin(past - wait);
  gain.add_wait(wait);
  EXPECT_TRUE(gain.begins_alone(2, [&] { return past; }));
  return gain.take_rounds([](std::size_t round) { return round < 1; }) == 1;
}

TEST(TeamGain, DoublesTheTimeAloneUntilTheTeamGains) {
  TeamGain gain;
  constexpr auto wait = milliseconds(2);
  EXPECT_FALSE(is_alone(gain, wait, milliseconds(5))) << "4 ms";
  EXPECT_FALSE(is_alone(gain, wait, milliseconds(9))) << "8 ms";
  for (int times = 0; times < 8; ++times) is_alone(gain, wait, milliseconds(0));
  EXPECT_FALSE(is_alone(gain, wait, milliseconds(1001))) << "1 s at most";
  gain.begin(TeamGain::Clock::time_point{});
  gain.add_wait(microseconds(1));
  EXPECT_FALSE(gain.begins_alone(2, [] { return TeamGain::Clock::time_point{} + milliseconds(500); }));
  EXPECT_TRUE(is_alone(gain, milliseconds(4), milliseconds(900))) << "1 s, of which half has been gained";
  gain.begin(TeamGain::Clock::time_point{});
  gain.add_wait(microseconds(1));
  EXPECT_FALSE(gain.begins_alone(2, [] { return TeamGain::Clock::time_point{} + milliseconds(1001); }));
  EXPECT_FALSE(is_alone(gain, milliseconds(4), milliseconds(5))) << "4 ms again";
  EXPECT_TRUE(is_alone(gain, std::chrono::seconds(60), milliseconds(0)));
}

TEST(TeamGain, TakesRoundsUntilNoneIsLeft) {
  TeamGain gain;
  const auto three = [](std::size_t round) { return round < 3; };
  EXPECT_EQ(gain.take_rounds(three), 0U) << "a team works first";
  const TeamGain::Clock::time_point future = TeamGain::Clock::now() + std::chrono::hours(1);
  gain.begin(future);
  gain.add_wait(milliseconds(50));
  ASSERT_TRUE(gain.begins_alone(2, [&] { return future; }));
  EXPECT_EQ(gain.take_rounds(three), 3U);
}

}  // namespace
}  // namespace mssim
