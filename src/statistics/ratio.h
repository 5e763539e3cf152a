#pragma once

#include <span>

namespace mssim {

/// How many times as long one thing takes as another, estimated on logarithms, where a factor is a shift and
/// neither of the two is the measure of the other.
struct RatioEstimate {
  double ratio = 1;
  double low = 1, high = 1;  ///< the 95 % interval
  bool covers = false;       ///< whether there are samples enough for one; else they are the outermost ratios
  double p = 1;              ///< two-sided: of ranks that differ so much, were there no difference
};

/// next / base of two independent samples of times: rank_sum_shift() and rank_sum_test() of the logarithms.
/// Throws std::invalid_argument for an empty sample or a time that is not finite and positive.
RatioEstimate ratio_of(std::span<const double> base, std::span<const double> next);

/// next[i] / base[i] of pairs: signed_rank_shift() and signed_rank_test(). `share`: of their errors that this
/// estimate may make, where it is one of several (looks.h): the interval misses in share times 5 % of the
/// cases, and p is what the test gives over the share. Throws like ratio_of(), and for samples of unequal
/// length.
RatioEstimate paired_ratio(std::span<const double> base, std::span<const double> next, double fraction = 1);

/// The geometric mean. Throws like ratio_of().
double geometric_mean(std::span<const double> ratios);

}  // namespace mssim
