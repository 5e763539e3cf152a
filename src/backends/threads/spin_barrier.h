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

/// A barrier for threads that meet every few microseconds (spin_wait.h says how it waits). At the end of a
/// round of their work one of them may take rounds alone, where that is faster.
class SpinBarrier {
 public:
  explicit SpinBarrier(std::size_t threads) : threads_(threads) {}
  /// `gain` lives as long, and is called by no other thread meanwhile. `begin`: since when the threads are
  /// under way.
  SpinBarrier(std::size_t threads, TeamGain& gain, TeamGain::Clock::time_point begin = TeamGain::Clock::now())
      : threads_(threads), gain_(&gain) {
    gain.begin(begin);
  }

  /// Returns when all threads have called it, or end_round(), as often as this one. What they wrote before is
  /// visible after.
  void wait() {
    const Arrival mine = arrive();
    if (mine.is_last)
      release(mine.phase);
    else
      wait_for_others(mine);
  }

  /// Meets the others at the end of a round. Meanwhile one thread may take rounds for all: take_round(n) with
  /// n from 0 on does the work of all threads in the (n + 1)th round after this one, or returns false where
  /// none is left. Returns to every thread how many rounds that were. `waited`: how long this thread has
  /// waited for others since the last such meeting, apart from here.
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
    const unsigned now =
        mine.is_last ? wait_for_change(phase_, mine.phase + 1, spins) : wait_for_others(mine);
    if (now == mine.phase + 1) {
      if (mine.is_first) {  // nothing has kept it from arriving: it has a processor
        rounds_alone_ = gain_->take_rounds(take_round);
        gain_->begin(Clock::now());
        release(mine.phase);
      } else {
        wait_for_change(phase_, mine.phase + 1, spins);
      }
    }
    return rounds_alone_;
  }

 private:
  using Clock = TeamGain::Clock;

  /// Some microseconds: about as long as the parts of a balanced step differ.
  static constexpr int spins = 300;

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

  /// Who arrives before the last one. Reads the clock in waits only that are long already: a step of the
  /// smallest cloths takes as long as a few hundred readings.
  unsigned wait_for_others(const Arrival& mine) {
    if (!mine.is_first || !gain_) return wait_for_change(phase_, mine.phase, spins);
    constexpr int first_spins = spins / 10;
    if (const unsigned now = spin_for_change(phase_, mine.phase, first_spins); now != mine.phase) return now;
    const Clock::time_point begin = Clock::now();
    const unsigned now = wait_for_change(phase_, mine.phase, spins - first_spins);
    // The last one may be the next to use it, but not before this thread has arrived again.
    gain_->add_wait(Clock::now() - begin);
    return now;
  }

  const std::size_t threads_;
  TeamGain* const gain_ = nullptr;  // of who is last, of the first in a wait, or of who works alone
  std::atomic<std::size_t> arrived_{0};
  std::atomic<TeamGain::Duration::rep> longest_wait_{0};  // of the threads' own since the last end_round()
  std::atomic<unsigned> phase_{0};  // two more after every meeting; one more while a thread is alone
  std::size_t rounds_alone_ = 0;
};

/// The threads that take a step together, as one of them sees them.
struct Team {
  std::size_t thread;
  std::size_t threads;
  SpinBarrier& barrier;

  void meet() const { barrier.wait(); }
  /// SpinBarrier::end_round.
  template <class TakeRound>
  std::size_t end_round(TakeRound&& take_round, TeamGain::Duration waited = {}) const {
    return barrier.end_round(std::forward<TakeRound>(take_round), waited);
  }

  /// Where this thread's slice of `count` things begins; the next thread's begins where it ends.
  std::size_t begin(std::size_t count) const { return count * thread / threads; }
  std::size_t end(std::size_t count) const { return count * (thread + 1) / threads; }
  template <class T>
  std::span<const T> slice_of(std::span<const T> all) const {
    return all.subspan(begin(all.size()), end(all.size()) - begin(all.size()));
  }
};

/// Calls act(team) on so many threads of OpenMP's, or on fewer where it gives no more. `gain`: what
/// SpinBarrier takes beside their number.
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
