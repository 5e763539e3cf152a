#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "bench/estimates.h"

namespace mssim {

/// Shares a bench's time out among its scenes, so that all get about as many rounds.
class TimeBudget {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts now. No `seconds` is no limit. Throws UsageError when the time is not enough for one round of
  /// each scene.
  TimeBudget(std::optional<double> seconds, std::vector<ExpectedTime> scenes);

  /// When all is to have ended; none without a limit.
  std::optional<Clock::time_point> end() const { return end_; }
  /// When the rounds of the next scene, which begins now, are to end; none without a limit.
  std::optional<Clock::time_point> begin_scene();
  /// The scene's first round has ended, which tells how far to believe what was expected.
  void first_round_done();

 private:
  std::optional<Clock::time_point> end_;
  std::vector<ExpectedTime> scenes_;  ///< those that have not begun
  ExpectedTime present_;
  Clock::time_point present_start_;
  double expected_ = 0, taken_ = 0;  ///< seconds up to the first round, of all scenes so far
};

}  // namespace mssim
