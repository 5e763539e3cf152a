#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace mssim {

/// Error probability of a 95 % interval.
inline constexpr double usual_error = 0.05;

/// Result of a test that uses only ranks: the probability of a statistic at least as extreme if there is no
/// difference.
struct RankTest {
  double statistic = 0;
  double p_less = 1;     ///< of a statistic as small or smaller
  double p_greater = 1;  ///< of a statistic as large or larger
  bool exact = false;    ///< else by the normal approximation, corrected for ties and continuity

  double p_two_sided() const { return std::min(1., 2 * std::min(p_less, p_greater)); }
};

/// An estimate of the shift of values, by the corresponding rank test.
struct ShiftEstimate {
  double shift = 0;          ///< Hodges and Lehmann's: the median of the values that the test compares
  double low = 0, high = 0;  ///< the interval, 95 % by default
  /// Whether the samples are large enough for such an interval; if not, low and high are the extreme values.
  bool covers = false;
};

/// Two independent samples, compared by rank.

/// Mann and Whitney's test: the statistic U is the number of pairs with x above y, a tie counting half. It is
/// small for small x (p_less), large for large x (p_greater). Exact for samples of fewer than 50 values
/// without ties, else normal, with the variance reduced for ties.
/// Source: M. Hollander, D. A. Wolfe, Nonparametric Statistical Methods, Wiley 1973, section 4.1.
/// Throws std::invalid_argument for an empty sample or a value that is not finite.
RankTest rank_sum_test(std::span<const double> x, std::span<const double> y);

/// How much larger x is: Hodges and Lehmann's median of the differences x - y over all pairs, and the
/// interval that inverts the test, from the k-th smallest to the k-th largest difference. It is valid for
/// every distribution if y is distributed like x except for the shift; ties make it conservative.
/// Source: as above, sections 4.2 and 4.3. Throws like rank_sum_test().
ShiftEstimate rank_sum_shift(std::span<const double> x, std::span<const double> y);

/// One sample of differences (of pairs), tested against zero by rank.

/// Wilcoxon's test: the statistic V is the sum of the ranks of |difference| over the positive differences;
/// small if most are negative (p_less), large if most are positive (p_greater). Zeros are omitted. Exact for
/// fewer than 50 values without ties and zeros, else normal, with the variance reduced for ties.
/// Source: M. Hollander, D. A. Wolfe, Nonparametric Statistical Methods, Wiley 1973, section 3.1.
/// Throws std::invalid_argument for no values or one that is not finite.
RankTest signed_rank_test(std::span<const double> differences);

/// The centre of the differences: Hodges and Lehmann's median of the averages of all pairs of values, each
/// also with itself (Walsh averages), and the interval that inverts the test, from the k-th smallest to the
/// k-th largest average. Its error probability is `error` for every symmetric distribution.
/// Source: as above, sections 3.2 and 3.3. Throws like signed_rank_test().
ShiftEstimate signed_rank_shift(std::span<const double> differences, double error = usual_error);

/// The distribution of a rank statistic if there is no difference: exactly, as a table, for samples of fewer
/// than `exact_below` without ties, else as a normal distribution with continuity correction. Symmetric about
/// its mean.
class RankDistribution {
 public:
  /// `ways[s]` of the equally likely arrangements give the statistic s.
  static RankDistribution exact(const std::vector<double>& ways);
  /// With a deviation of 0 (all values are tied), every statistic has probability 1.
  static RankDistribution normal(double mean, double deviation);

  bool is_exact() const { return !at_most_.empty(); }
  /// P(S <= statistic)
  double at_most(double statistic) const;
  /// P(S >= statistic)
  double at_least(double statistic) const { return at_most(2 * mean_ - statistic); }
  /// The largest k with P(S < k) <= error / 2: the interval from the k-th smallest to the k-th largest of the
  /// compared values has error probability `error`. 0 if the sample is too small for one.
  std::size_t interval_rank(double error = usual_error) const;

 private:
  std::vector<double> at_most_;
  double mean_ = 0, deviation_ = 0;
};

/// The exact distribution is computed for samples of fewer values.
inline constexpr std::size_t exact_below = 50;

/// The distribution of Mann and Whitney's U, the number of pairs (x, y) with x > y, for samples of these
/// sizes without ties. Exact: each set of ranks of x is equally likely; they are counted by the
/// sum of their ranks. Source: H. B. Mann, D. R. Whitney, On a test of whether one of two random variables is
/// stochastically larger than the other, Annals of Mathematical Statistics 18, 1947.
RankDistribution rank_sum_distribution(std::size_t x_size, std::size_t y_size);

/// The distribution of Wilcoxon's V, the sum of the ranks of the positive values, for that many values
/// without ties and zeros. Exact: each rank belongs to a positive or a negative value with equal probability.
/// Source: F. Wilcoxon, Individual comparisons by ranking methods, Biometrics Bulletin 1, 1945.
RankDistribution signed_rank_distribution(std::size_t size);

}  // namespace mssim
