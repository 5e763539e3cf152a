#pragma once

#include <optional>

namespace mssim {

/// What processes that take steps together spend on each other.
struct Communication {
  double waiting = 0;  ///< share of the time of a step that a process waits for others; mean of all
  /// The same for bringing together what is sent, bringing it across where the processor does that, and
  /// putting in place what has come.
  double packing = 0;
  double bytes = 0;     ///< that the process with most sends in a step
  double messages = 0;  ///< the same
  /// Half of the time that a message of a few bytes takes to a neighbour and back, s, where it takes longest;
  /// none where there is no neighbour.
  std::optional<double> latency_s;
  std::optional<double> bytes_per_second;  ///< of large messages to a neighbour, where they are slowest

  friend bool operator==(const Communication& a, const Communication& b) = default;
};

}  // namespace mssim
