#pragma once

#include <chrono>
#include <cstdint>

namespace mssim {

/// What a rank has done for others in all its steps so far.
struct RankCosts {
  double waited_s = 0;  ///< for messages that the next columns or nodes needed
  /// Bringing together what was sent, bringing it across where the processor has to, and putting in place
  /// what came.
  double packed_s = 0;
  std::uint64_t bytes = 0;     ///< sent
  std::uint64_t messages = 0;  ///< the same
};

/// Adds the seconds that it lives to such a number.
class SecondsAdded {
 public:
  explicit SecondsAdded(double& seconds) : seconds_(seconds) {}
  ~SecondsAdded() { seconds_ += std::chrono::duration<double>(Clock::now() - begin_).count(); }
  SecondsAdded(const SecondsAdded&) = delete;
  SecondsAdded& operator=(const SecondsAdded&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& seconds_;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace mssim
