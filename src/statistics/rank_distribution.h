#pragma once

#include <cstddef>
#include <vector>

namespace mssim {

/// Of a 95 % interval.
inline constexpr double usual_error = 0.05;

/// How a rank statistic is distributed where there is nothing to find: exactly, as a table, for samples of
/// fewer than `exact_below` without ties, else as a normal distribution with continuity correction. Symmetric
/// about its mean.
class RankDistribution {
 public:
  /// `ways[s]` of the equally likely arrangements give the statistic s.
  static RankDistribution exact(const std::vector<double>& ways);
  /// A deviation of 0 (all values are tied) makes every statistic as likely as can be.
  static RankDistribution normal(double mean, double deviation);

  bool is_exact() const { return !at_most_.empty(); }
  /// P(S <= statistic)
  double at_most(double statistic) const;
  /// P(S >= statistic)
  double at_least(double statistic) const { return at_most(2 * mean_ - statistic); }
  /// The largest k with P(S < k) <= error / 2: from the k-th smallest to the k-th largest of the values whose
  /// comparisons the statistic counts is an interval that misses in `error` of the cases. 0 where there is
  /// none, because the sample is too small.
  std::size_t interval_rank(double error = usual_error) const;

 private:
  std::vector<double> at_most_;
  double mean_ = 0, deviation_ = 0;
};

/// Samples of fewer values have their exact distribution computed.
inline constexpr std::size_t exact_below = 50;

/// Of Mann and Whitney's U, the number of pairs (x, y) with x > y, for samples of these sizes without ties.
/// Exact: each set of ranks that x may have is equally likely; they are counted by the sum of their ranks.
/// Source: H. B. Mann, D. R. Whitney, On a test of whether one of two random variables is stochastically
/// larger than the other, Annals of Mathematical Statistics 18, 1947.
RankDistribution rank_sum_distribution(std::size_t x_size, std::size_t y_size);

/// Of Wilcoxon's V, the sum of the ranks of the positive values, for that many values without ties and zeros.
/// Exact: each rank is as likely to belong to a positive value as to a negative one.
/// Source: F. Wilcoxon, Individual comparisons by ranking methods, Biometrics Bulletin 1, 1945.
RankDistribution signed_rank_distribution(std::size_t size);

}  // namespace mssim
