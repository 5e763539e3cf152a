#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace mssim {

/// Decides whether threads that synchronise in every phase continue together, or one of them does all the
/// work for a while. If threads share a core with each other or with other programs, every synchronisation
/// may take as long as the system lets another program run, milliseconds, and one thread is faster.
///
/// The time that a team gains over one thread is summed. In a time t, in which the first thread to arrive has
/// waited for the last one for w, n threads do the work of one thread in n (t - w). When the sum has become
/// negative, one thread works alone, each time for twice as long, until the team has gained as much as that
/// time: on a busy machine threads often run simultaneously for some milliseconds, and then do not for many.
///
/// Use one object for all work of one kind, because its history is worth more than one call. One thread calls
/// it at a time.
class TeamGain {
 public:
  using Clock = std::chrono::steady_clock;
  using Duration = Clock::duration;
  /// Sleeping threads may take this long until all work.
  static constexpr Duration start = std::chrono::microseconds(1500);
  /// Maximum gain that is remembered: how much a team may lose in an isolated interruption.
  static constexpr Duration most = std::chrono::milliseconds(3);
  static constexpr Duration shortest = std::chrono::milliseconds(4);  ///< minimum time alone
  static constexpr Duration longest = std::chrono::seconds(1);        ///< maximum time alone

  /// A team begins to work; the time before does not count.
  void begin(Clock::time_point now) { counted_ = now; }

  /// The first thread to arrive has waited `wait` for the last one. Short waits may be omitted.
  void add_wait(Duration wait) { waited_ += wait; }

  /// If the team of `threads` threads has lost time, one thread works alone from now on: returns true. Reads
  /// the clock, now(), only after a wait.
  template <class Now>
  bool begins_alone(Duration::rep threads, Now&& now) {
    if (waited_ == Duration::zero()) return false;
    const Clock::time_point end = now();
    const Duration gain = (threads - 1) * (end - counted_) - threads * waited_;
    gained_ = std::min(gained_ + gain, most);
    gained_together_ += gain;
    counted_ = end;
    waited_ = Duration::zero();
    if (gained_together_ >= alone_) alone_ = Duration::zero();
    if (gained_ >= Duration::zero()) return false;
    alone_ = std::min(std::max({2 * alone_, -2 * gained_, shortest}), longest);
    end_alone_ = end + alone_;
    gained_ = start;
    gained_together_ = Duration::zero();
    return true;
  }

  /// While one thread is to work alone, calls take_round(n), n = 0, 1, ..., until that returns false because
  /// no round is left. Returns the number of rounds taken.
  template <class TakeRound>
  std::size_t take_rounds(TakeRound&& take_round) const {
    std::size_t rounds = 0;
    while (Clock::now() < end_alone_ && take_round(rounds)) ++rounds;
    return rounds;
  }

 private:
  Clock::time_point counted_{};  // time up to which gained_ counts
  Duration waited_{0};           // since then
  Duration gained_ = start;
  Duration gained_together_{0};  // since a thread last worked alone
  Duration alone_{0};            // last time alone, unless the team has gained as much since
  Clock::time_point end_alone_{};
};

}  // namespace mssim
