#include "backends/threads/thread_progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <thread>

namespace mssim {
namespace {

TEST(ThreadProgress, LetsTwoThreadsFollowEachOther) {
  ThreadProgress first, second;
  // No atomics: progress makes writes visible, and the thread sanitizer checks that.
  std::uint64_t written = 0;
  int wrong = 0;
  constexpr std::uint64_t passes = 20'000;
  std::thread follower([&] {
    TeamGain::Duration waited{};
    for (std::uint64_t pass = 1; pass <= passes; ++pass) {
      first.wait_for(pass, waited);
      if (written != pass) ++wrong;
      second.reach(pass);
    }
  });
  TeamGain::Duration waited{};
  for (std::uint64_t pass = 1; pass <= passes; ++pass) {
    written = pass;
    first.reach(pass);
    second.wait_for(pass, waited);
  }
  follower.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(written, passes);
}

TEST(ThreadProgress, SaysHowLongALongWaitWas) {
  ThreadProgress progress;
  constexpr std::chrono::milliseconds late(20);
  std::thread other([&] {
    std::this_thread::sleep_for(late);
    progress.reach(3);
  });
  TeamGain::Duration waited = std::chrono::seconds(1);
  progress.wait_for(3, waited);
  other.join();
  // The thread may have started before this one began to wait.
  EXPECT_GT(waited, std::chrono::seconds(1) + late / 4);
}

TEST(ThreadProgress, DoesNotCountWhatIsThereAlready) {
  ThreadProgress progress;
  progress.reach(5);
  TeamGain::Duration waited{};
  progress.wait_for(4, waited);
  progress.wait_for(5, waited);
  EXPECT_EQ(waited, TeamGain::Duration::zero());
}

}  // namespace
}  // namespace mssim
