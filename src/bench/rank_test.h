#pragma once

#include <algorithm>

namespace mssim {

/// What a test that uses ranks alone found: the probability of a statistic at least as far out, were there
/// nothing to find.
struct RankTest {
  double statistic = 0;
  double p_less = 1;     ///< of one as small
  double p_greater = 1;  ///< of one as large
  bool exact = false;    ///< else by the normal approximation, corrected for ties and continuity

  double p_two_sided() const { return std::min(1., 2 * std::min(p_less, p_greater)); }
};

/// An estimate of how far values are shifted, by the test that belongs to it.
struct ShiftEstimate {
  double shift = 0;
  double low = 0, high = 0;  ///< the 95 % interval
  /// Whether the samples are large enough for such an interval. Else low and high are the outermost values.
  bool covers = false;
};

}  // namespace mssim
