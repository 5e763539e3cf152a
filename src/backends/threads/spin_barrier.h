#pragma once

#include <omp.h>

#include <atomic>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "backends/threads/spin_wait.h"
#include "backends/threads/team_gain.h"

namespace mssim {

/// A barrier for threads that synchronise every few microseconds; see spin_wait.h for how it waits. At the
/// end of a round, one of them may take rounds alone if that is faster.
class SpinBarrier {
 public:
  explicit SpinBarrier(std::size_t threads) : threads_(threads) {}
  /// `gain` must outlive it, and no other thread may call it meanwhile. `begin`: start of the threads' work.
  SpinBarrier(std::size_t threads, TeamGain& gain, TeamGain::Clock::time_point begin = TeamGain::Clock::now())
      : threads_(threads), gain_(&gain) {
    gain.begin(begin);
  }

  /// Returns when all threads have called it, or end_round(), as often as this one. Earlier writes are then
  /// visible.
  void wait() {
    const Arrival mine = arrive();
    if (mine.is_last)
      release(mine.phase);
    else
      wait_for_others(mine);
  }

  /// Synchronises at the end of a round. Meanwhile one thread may take rounds for all: take_round(n), n = 0,
  /// 1, ..., does the work of all threads in the (n + 1)th round after this one, or returns false if none is
  /// left. Returns the number of these rounds to every thread. `waited`: time that this thread has waited for
  /// others since the last call, apart from here.
  template <class TakeRound>
  std::size_t end_round(TakeRound&& take_round, TeamGain::Duration waited = {}) {
    TeamGain::Duration::rep longest = longest_wait_.load(std::memory_order_relaxed);
    while (waited.count() > longest &&
           !longest_wait_.compare_exchange_weak(longest, waited.count(), std::memory_order_relaxed)) {
    }
    const Arrival mine = arrive();
    if (mine.is_last) {
      rounds_alone_ = 0;
      if (gain_) gain_->add_wait(TeamGain::Duration(longest_wait_.exchange(0, std::memory_order_relaxed)));
      if (threads_ == 1 || !gain_ ||
          !gain_->begins_alone(static_cast<TeamGain::Duration::rep>(threads_), &Clock::now)) {
        release(mine.phase);
        return 0;
      }
      change_and_notify(phase_, mine.phase + 1);
    }
    const unsigned now = mine.is_last
                             ? wait_for_change(phase_, mine.phase + 1, patience_.spins, patience_.yields)
                             : wait_for_others(mine);
    if (now == mine.phase + 1) {
      if (mine.is_first) {  // not delayed: it has a core
        rounds_alone_ = gain_->take_rounds(take_round);
        gain_->begin(Clock::now());
        release(mine.phase);
      } else {
        wait_for_change(phase_, mine.phase + 1, patience_.spins, patience_.yields);
      }
    }
    return rounds_alone_;
  }

 private:
  using Clock = TeamGain::Clock;

  /// How a thread waits before it sleeps: the spins take some microseconds, about the imbalance of a balanced
  /// step. With more threads than CPUs the one that others wait for may need their CPU.
  struct Patience {
    int spins, yields;
  };
  static Patience patience_of(std::size_t threads) {
    static const auto processors = static_cast<std::size_t>(omp_get_num_procs());
    return threads > processors ? Patience{0, 5} : Patience{300, 100};
  }

  struct Arrival {
    unsigned phase;
    bool is_first, is_last;
  };

  Arrival arrive() {
    const unsigned phase = phase_.load(std::memory_order_acquire);
    const std::size_t before = arrived_.fetch_add(1, std::memory_order_acq_rel);
    return {phase, before == 0, before + 1 == threads_};
  }

  void release(unsigned phase) {
    arrived_.store(0, std::memory_order_relaxed);
    change_and_notify(phase_, phase + 2);
  }

  /// For threads before the last one. Reads the clock only in long waits: a step of the smallest cloths takes
  /// as long as a few hundred readings.
  unsigned wait_for_others(const Arrival& mine) {
    if (!mine.is_first || !gain_)
      return wait_for_change(phase_, mine.phase, patience_.spins, patience_.yields);
    const int first_spins = patience_.spins / 10;
    if (const unsigned now = spin_for_change(phase_, mine.phase, first_spins); now != mine.phase) return now;
    const Clock::time_point begin = Clock::now();
    const unsigned now = wait_for_change(phase_, mine.phase, patience_.spins - first_spins, patience_.yields);
    // The last thread may use it next, but not before this thread has arrived again.
    gain_->add_wait(Clock::now() - begin);
    return now;
  }

  const std::size_t threads_;
  const Patience patience_ = patience_of(threads_);
  TeamGain* const gain_ = nullptr;  // used by the last, the first waiting, or the lone thread
  std::atomic<std::size_t> arrived_{0};
  std::atomic<TeamGain::Duration::rep> longest_wait_{
      0};                           // maximum over the threads since the last end_round()
  std::atomic<unsigned> phase_{0};  // two more after every meeting; one more while a thread works alone
  std::size_t rounds_alone_ = 0;
};

/// The threads that take a step together, from the view of one of them.
struct Team {
  std::size_t thread;
  std::size_t threads;
  SpinBarrier& barrier;

  void meet() const { barrier.wait(); }
  /// See SpinBarrier::end_round.
  template <class TakeRound>
  std::size_t end_round(TakeRound&& take_round, TeamGain::Duration waited = {}) const {
    return barrier.end_round(std::forward<TakeRound>(take_round), waited);
  }

  /// Begin of this thread's slice of `count` items; the next thread's begins at its end.
  std::size_t begin(std::size_t count) const { return count * thread / threads; }
  std::size_t end(std::size_t count) const { return count * (thread + 1) / threads; }
  template <class T>
  std::span<const T> slice_of(std::span<const T> all) const {
    return all.subspan(begin(all.size()), end(all.size()) - begin(all.size()));
  }
};

/// Calls act(team) on `threads` OpenMP threads, or fewer if OpenMP gives no more. `gain`: SpinBarrier's
/// further arguments.
template <class Act, class... Gain>
void with_team(std::size_t threads, const Act& act, Gain&&... gain) {
  std::optional<SpinBarrier> barrier;
#pragma omp parallel num_threads(static_cast <int>(threads))
  {
    const auto given = static_cast<std::size_t>(omp_get_num_threads());
#pragma omp single
    barrier.emplace(given, std::forward<Gain>(gain)...);
    act(Team{static_cast<std::size_t>(omp_get_thread_num()), given, *barrier});
  }
}

}  // namespace mssim
