#include <sched.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "backends/threads/chunk_tickets.h"
#include "backends/threads/spin_barrier.h"
#include "backends/threads/spin_wait.h"
#include "backends/threads/team_gain.h"
#include "tests/support/testing.h"

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

/// Calls `run` in so many threads, with the number of each, and waits for all.
void in_threads(std::uint32_t threads, const std::function<void(std::uint32_t thread)>& run) {
  std::vector<std::jthread> group;
  for (std::uint32_t thread = 0; thread < threads; ++thread)
    group.emplace_back([&run, thread] { run(thread); });
}

constexpr std::uint32_t phase_count = 2000, chunk_count = 5;

/// Counts who took what, and who took a chunk of another phase than is open.
class Ledger {
 public:
  void open(std::uint32_t phase) { open_phase_ = phase; }
  void take(const ChunkTickets::Ticket& ticket) {
    if (ticket.phase != open_phase_) ++out_of_turn_;
    ++taken_[ticket.phase * chunk_count + ticket.chunk];
  }
  void expect_phase_whole(std::uint32_t phase) const {
    for (std::uint32_t chunk = 0; chunk < chunk_count; ++chunk)
      EXPECT_EQ(taken_[phase * chunk_count + chunk], 1) << phase << ", " << chunk;
    EXPECT_EQ(out_of_turn_, 0);
  }

 private:
  std::vector<std::atomic<int>> taken_ = std::vector<std::atomic<int>>(phase_count * chunk_count);
  std::atomic<int> out_of_turn_{0};
  std::atomic<std::uint32_t> open_phase_{0};
};

TEST(ChunkTickets, GiveEveryChunkOfEveryPhaseToOneThreadAndFinishAPhaseBeforeTheNext) {
  for (const int helpers : {0, 1, 3}) {
    SCOPED_TRACE(std::to_string(helpers) + " helpers");
    ChunkTickets tickets(chunk_count);
    Ledger ledger;
    const auto act = [&](const ChunkTickets::Ticket& ticket) { ledger.take(ticket); };
    std::vector<std::jthread> group;
    for (int i = 0; i < helpers; ++i)
      group.emplace_back([&] { tickets.work_until_closed(0, 0, act, [] {}); });
    for (std::uint32_t phase = 0; phase < phase_count; ++phase) {
      ledger.open(phase);
      tickets.open();
      tickets.work(0, act);
      tickets.wait_until_finished();
      ledger.expect_phase_whole(phase);
    }
    tickets.close();
  }
}

TEST(ChunkTickets, NeedNoLeader) {
  for (const std::uint32_t threads : {1U, 2U, 3U, 7U}) {  // seven: ranges without a chunk
    SCOPED_TRACE(std::to_string(threads) + " threads");
    ChunkTickets tickets(chunk_count, threads);
    Ledger ledger;
    std::uint32_t phase = 0;
    tickets.open();
    in_threads(threads, [&](std::uint32_t thread) {
      tickets.work_until_closed(
          thread, 100, [&](const ChunkTickets::Ticket& ticket) { ledger.take(ticket); },
          [&] {
            ledger.expect_phase_whole(phase);
            if (++phase == phase_count) return tickets.close();
            ledger.open(phase);
            tickets.open();
          });
    });
    EXPECT_EQ(phase, phase_count);
  }
}

TEST(ChunkTickets, LetPhasesPassWhileAThreadSleepsAndItJoinInThePresentOne) {
  ChunkTickets tickets(4, 2);
  std::vector<std::uint32_t> early;
  for (int phase = 0; phase < 10; ++phase) {
    tickets.open();
    EXPECT_TRUE(tickets.work(0, [&](const ChunkTickets::Ticket& ticket) { early.push_back(ticket.chunk); }));
  }
  EXPECT_EQ(std::vector(early.begin(), early.begin() + 4), (std::vector<std::uint32_t>{0, 1, 3, 2}))
      << "its own from the front, then others' from the back";
  EXPECT_EQ(early.size(), 40U);
  tickets.open();
  std::vector<std::uint32_t> late;
  EXPECT_TRUE(tickets.work(1, [&](const ChunkTickets::Ticket& ticket) {
    EXPECT_EQ(ticket.phase, 10U);
    late.push_back(ticket.chunk);
  }));
  EXPECT_EQ(late, (std::vector<std::uint32_t>{2, 3, 1, 0}));
}

TEST(ChunkTickets, HaveNothingToTakeBeforeAPhaseOpensAndAfterAllIsTaken) {
  ChunkTickets tickets(2);
  int taken = 0;
  const auto act = [&](const ChunkTickets::Ticket&) { ++taken; };
  EXPECT_FALSE(tickets.work(0, act));
  EXPECT_EQ(taken, 0);
  tickets.open();
  EXPECT_TRUE(tickets.work(0, act));
  EXPECT_FALSE(tickets.work(0, act));
  EXPECT_EQ(taken, 2);
  tickets.close();
  EXPECT_FALSE(tickets.work(0, act));
  tickets.work_until_closed(0, 0, act, [] { FAIL() << "nothing was open"; });
  EXPECT_EQ(taken, 2);
}

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
    in_threads(8, [&](std::uint32_t part) { rounds.run(barrier, part, [] {}); });
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
  in_threads(3, [&](std::uint32_t part) { rounds.run(barrier, part, [] {}); });
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
