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

}  // namespace mssim
