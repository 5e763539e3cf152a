#pragma once

#include <span>

#include "statistics/rank_test.h"
#include "statistics/shift_estimate.h"

namespace mssim {

/// One sample of differences (of pairs), held against zero by their ranks.

/// Wilcoxon's test: the statistic V is the sum of the ranks of |difference| over the positive differences;
/// small where most are negative (p_less), large where most are positive (p_greater). Zeros are left out.
/// Exact for fewer than 50 values without ties and zeros, else normal, the variance reduced for ties.
/// Source: M. Hollander, D. A. Wolfe, Nonparametric Statistical Methods, Wiley 1973, section 3.1.
/// Throws std::invalid_argument for no values or one that is not finite.
RankTest signed_rank_test(std::span<const double> differences);

/// Their centre: Hodges and Lehmann's median of the averages of all pairs of values, each also with itself
/// (Walsh averages), and the interval that inverts the test, from the k-th smallest to the k-th largest
/// average; it misses in `error` of the cases, for whatever symmetric distribution.
/// Source: as above, sections 3.2 and 3.3. Throws like signed_rank_test().
ShiftEstimate signed_rank_shift(std::span<const double> differences, double error = usual_error);

}  // namespace mssim
