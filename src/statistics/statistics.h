#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mssim {

/// The median of a sample and an interval for the median of the distribution behind it, in the sample's unit.
struct MedianInterval {
  double median = 0;
  double low = 0;   ///< a sample
  double high = 0;  ///< a sample
  /// Probability that such an interval holds the true median: at least 0.95 from 6 samples on. Fewer samples
  /// have no 95 % interval at all; then low and high are the smallest and the largest sample and this number
  /// is what they are worth (2 samples: 0.5, 5 samples: 0.9375).
  double coverage = 0;
};

/// What `low` and `high` of a MedianInterval cover at least, where the number of samples allows it.
inline constexpr double interval_confidence = 0.95;

/// Probability that the median of a distribution lies between the rank-th smallest and the rank-th largest of
/// `samples` independent draws. The number of draws below the median is binomial with p = 1/2, so this is
///     1 - 2 P(B(samples, 1/2) < rank),
/// whatever the distribution, if it is continuous; draws that can tie make it a lower bound.
/// Source: H. A. David, H. N. Nagaraja, Order Statistics, 3rd ed., Wiley 2003, section 7.1.
/// `rank` counts from 1 and is at most (samples + 1) / 2; 0 covers everything.
double rank_coverage(std::size_t samples, std::size_t rank);

/// The largest rank whose interval still covers 95 %, so the narrowest such interval with as many samples
/// outside it on either side; 0 where there is none (fewer than 6 samples). The binomial distribution takes
/// steps, so that the coverage is often well above 95 %; nothing is interpolated.
std::size_t interval_rank(std::size_t samples);

/// The samples in ascending order. Throws std::invalid_argument for no samples or for one that is not finite.
std::vector<double> ascending(std::span<const double> samples);

/// The middle sample, or the mean of the two middle ones. Throws like ascending().
double median(std::span<const double> samples);

/// Mean, and standard deviation of the distribution as estimated from the sample (division by n - 1), for
/// formats that ask for them: both follow outliers, which the median does not.
struct MeanDeviation {
  double mean = 0;
  double deviation = 0;  ///< 0 for a single sample
};
/// Throws std::invalid_argument for no samples.
MeanDeviation mean_deviation(std::span<const double> samples);

/// Throws like median().
MedianInterval median_interval(std::span<const double> samples);

/// The median of numerator[round] / denominator[round], with its interval. The ratio is taken round by round:
/// what slowed one round down slowed both of its samples, and drops out. Throws like median(), and
/// std::invalid_argument for unequal lengths.
MedianInterval median_ratio(std::span<const double> numerators, std::span<const double> denominators);

}  // namespace mssim
