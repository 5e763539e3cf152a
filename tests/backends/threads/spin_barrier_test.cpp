#include "backends/threads/spin_barrier.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <thread>
#include <vector>

namespace mssim {
namespace {

/// Binds the calling thread, and those that it starts, to the CPU that it is on.
class OnOneCpu {
 public:
  OnOneCpu() {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(sched_getcpu()), &one);
    bound_ =
        sched_getaffinity(0, sizeof before_, &before_) == 0 && sched_setaffinity(0, sizeof one, &one) == 0;
  }
  ~OnOneCpu() {
    if (bound_) sched_setaffinity(0, sizeof before_, &before_);
  }
  OnOneCpu(const OnOneCpu&) = delete;
  OnOneCpu& operator=(const OnOneCpu&) = delete;
  bool bound() const { return bound_; }

 private:
  cpu_set_t before_{};
  bool bound_ = false;
};

/// Rounds of two phases, in which every part is due once. A thread has a part, and the alone have all.
class Rounds {
 public:
  Rounds(std::size_t parts, std::size_t rounds) : done_(parts), rounds_(rounds) {}

  /// What one of as many threads as parts does. `between` is called in every round.
  template <class Between>
  void run(SpinBarrier& barrier, std::size_t part, Between&& between) {
    for (std::size_t round = 0; round < rounds_; ++round) {
      advance(part, 2 * round);
      between();
      barrier.wait();
      expect_all(2 * round + 1);
      barrier.wait();
      advance(part, 2 * round + 1);
      const std::size_t alone = barrier.end_round([&](std::size_t taken) {
        const std::size_t next = round + 1 + taken;
        if (next >= rounds_) return false;
        expect_all(2 * next);
        for (std::size_t phase : {2 * next, 2 * next + 1})
          for (std::size_t each = 0; each < done_.size(); ++each) advance(each, phase);
        ++alone_;
        return true;
      });
      round += alone;
    }
  }
  void expect_whole() {
    expect_all(2 * rounds_);
    EXPECT_EQ(wrong_, 0);
  }
  std::size_t alone() const { return alone_; }

 private:
  // No atomics: the barrier makes writes visible, and the thread sanitizer checks that.
  void advance(std::size_t part, std::size_t phase) {
    if (done_[part]++ != phase) ++wrong_;
  }
  void expect_all(std::size_t phases) {
    for (const std::size_t done : done_)
      if (done != phases) ++wrong_;
  }

  std::vector<std::size_t> done_;
  const std::size_t rounds_;
  std::atomic<int> wrong_{0};
  std::size_t alone_ = 0;
};

TEST(SpinBarrier, LetsEightThreadsOfOneCpuTakeEveryRoundOnce) {
  const OnOneCpu one;
  if (!one.bound()) GTEST_SKIP() << "threads cannot be bound";
  TeamGain gain;
  for (int call = 0; call < 3; ++call) {
    Rounds rounds(8, 1000);
    SpinBarrier barrier(8, gain);
    {
      std::vector<std::jthread> group;
      for (std::size_t part = 0; part < 8; ++part)
        group.emplace_back([&, part] { rounds.run(barrier, part, [] {}); });
    }
    rounds.expect_whole();
  }
}

TEST(SpinBarrier, LetsOneThreadWorkAloneWhereAnotherIsLate) {
  TeamGain gain;
  Rounds rounds(2, 1000);
  SpinBarrier barrier(2, gain);
  {
    const std::jthread other(
        [&] { rounds.run(barrier, 1, [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }); });
    rounds.run(barrier, 0, [] {});
  }
  rounds.expect_whole();
  EXPECT_GT(rounds.alone(), 0U);
}

TEST(SpinBarrier, LetsOneThreadWorkAloneWhereThreadsSayThatTheyHaveWaited) {
  // Both arrive at the same time, but one has waited before for most of it.
  TeamGain gain;
  SpinBarrier barrier(2, gain);
  std::atomic<int> alone{0};
  const auto run = [&](TeamGain::Duration waited) {
    for (int round = 0; round < 40; ++round) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const auto take = [&](std::size_t) { return ++alone, false; };
      barrier.end_round(take, waited);
    }
  };
  {
    const std::jthread other([&] { run(std::chrono::milliseconds(1)); });
    run({});
  }
  EXPECT_GT(alone.load(), 0);
}

TEST(SpinBarrier, KeepsThreadsTogetherWithoutATeamGain) {
  Rounds rounds(3, 200);
  SpinBarrier barrier(3);
  {
    std::vector<std::jthread> group;
    for (std::size_t part = 0; part < 3; ++part)
      group.emplace_back([&, part] { rounds.run(barrier, part, [] {}); });
  }
  rounds.expect_whole();
  EXPECT_EQ(rounds.alone(), 0U);
}

TEST(SpinBarrier, IsNoneForOneThread) {
  TeamGain gain;
  gain.add_wait(std::chrono::seconds(1));
  Rounds rounds(1, 100);
  SpinBarrier barrier(1, gain);
  rounds.run(barrier, 0, [] {});
  rounds.expect_whole();
  EXPECT_EQ(rounds.alone(), 0U);
}

}  // namespace
}  // namespace mssim
