#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace mssim {

/// Decides whether threads that meet in every phase of their work go on together, or one of them does the
/// work of all for a while. Where threads share a processor with each other or with other programs, every
/// meeting may take as long as the system lets another run, milliseconds, and one thread is faster.
///
/// The time that a team gains over one thread is summed. In a time t, in which the first thread to arrive has
/// waited for the last one for w, n threads do what one does in n (t - w). When the sum has become negative,
/// one thread works alone, each time for twice as long, until the team has gained as much as that time: on a
/// busy machine threads often run beside each other for some milliseconds, and then do not for many.
///
/// One object for all work of one kind, since what it has learned is worth more than one call. One thread
/// calls it at a time.
class TeamGain {
 public:
  using Clock = std::chrono::steady_clock;
  using Duration = Clock::duration;
  /// Threads that were asleep may take that long until all work.
  static constexpr Duration start = std::chrono::microseconds(1500);
  /// What is remembered of a team's gains: how much it may lose in an interruption that does not recur.
  static constexpr Duration most = std::chrono::milliseconds(3);
  static constexpr Duration shortest = std::chrono::milliseconds(4);  ///< time alone
  static constexpr Duration longest = std::chrono::seconds(1);        ///< the same

  /// A team begins to work, after a time that does not count.
  void begin(Clock::time_point now) { counted_ = now; }

  /// The first thread to arrive has waited so long for the last one. Short waits may be left out.
  void add_wait(Duration wait) { waited_ += wait; }

  /// Where the team of so many threads has lost time, lets one thread work alone from now on, and says so.
  /// Asks for the time only after a wait: now().
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
  /// no round is left. Returns how many rounds were taken.
  template <class TakeRound>
  std::size_t take_rounds(TakeRound&& take_round) const {
    std::size_t rounds = 0;
    while (Clock::now() < end_alone_ && take_round(rounds)) ++rounds;
    return rounds;
  }

 private:
  Clock::time_point counted_{};  // until when gained_ counts
  Duration waited_{0};           // since then
  Duration gained_ = start;
  Duration gained_together_{0};  // since a thread was alone
  Duration alone_{0};            // the last time, unless the team has gained as much since
  Clock::time_point end_alone_{};
};

}  // namespace mssim
