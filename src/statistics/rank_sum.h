#pragma once

#include <span>

#include "statistics/rank_test.h"
#include "statistics/shift_estimate.h"

namespace mssim {

/// Two independent samples, compared by their ranks alone.

/// Mann and Whitney's test: the statistic U is the number of pairs with x above y, a tie counting half; few
/// for small x (p_less), many for large x (p_greater). Exact for samples of fewer than 50 values without
/// ties, else normal, the variance reduced for ties.
/// Source: M. Hollander, D. A. Wolfe, Nonparametric Statistical Methods, Wiley 1973, section 4.1.
/// Throws std::invalid_argument for an empty sample or a value that is not finite.
RankTest rank_sum_test(std::span<const double> x, std::span<const double> y);

/// By how much x is larger: Hodges and Lehmann's median of the differences x - y over all pairs, and the
/// interval that inverts the test, from the k-th smallest to the k-th largest difference. It holds whatever
/// the distribution, if y is distributed as x but for the shift; ties make it wider than it need be.
/// Source: as above, sections 4.2 and 4.3. Throws like rank_sum_test().
ShiftEstimate rank_sum_shift(std::span<const double> x, std::span<const double> y);

}  // namespace mssim
