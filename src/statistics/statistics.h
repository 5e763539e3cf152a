#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
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

/// The value that a fraction (0 to 1) of the values lie below: one of them, which is not interpolated; 1 is
/// the largest. There is one value at least.
double quantile(std::vector<double> values, double fraction);

/// First and third quartile: the samples number p (n + 1), p = 1/4 and 3/4, counted from 1 in ascending
/// order, interpolated between two and kept within the smallest and the largest.
/// Source: NIST/SEMATECH e-Handbook of Statistical Methods, section 7.1.6.
struct Quartiles {
  double first = 0;
  double third = 0;
};
/// Throws std::invalid_argument for no samples or for one that is not finite.
Quartiles quartiles(std::span<const double> samples);

/// How far a sample lies from the rest.
enum class Outlier : std::uint8_t { no, mild, extreme };

/// "", "mild" or "extreme".
std::string_view name_of(Outlier outlier);

/// A label for every sample: mild beyond the inner fences, 1.5 interquartile ranges outside the quartiles;
/// extreme beyond the outer ones, 3 of them. For the readers of samples: none is left out of any number.
/// Source: J. W. Tukey, Exploratory Data Analysis, Addison-Wesley 1977. Throws like quartiles().
std::vector<Outlier> outliers(std::span<const double> samples);

/// How many times as long one thing takes as another, estimated on logarithms, where a factor is a shift and
/// neither of the two is the measure of the other.
struct RatioEstimate {
  double ratio = 1;
  double low = 1, high = 1;  ///< the 95 % interval
  bool covers = false;       ///< whether there are samples enough for one; else they are the outermost ratios
  double p = 1;              ///< two-sided: of ranks that differ so much, were there no difference
};

/// next / base of two independent samples of times: rank_sum_shift() and rank_sum_test() (rank_tests.h) of
/// the logarithms. Throws std::invalid_argument for an empty sample or a time that is not finite and
/// positive.
RatioEstimate ratio_of(std::span<const double> base, std::span<const double> next);

/// next[i] / base[i] of pairs: signed_rank_shift() and signed_rank_test(). `fraction` is that of their error
/// which this estimate may make, where it is one of several (Look): the interval misses in fraction times 5 %
/// of the cases, and p is what the test gives over the fraction. Throws like ratio_of(), and for samples of
/// unequal length.
RatioEstimate paired_ratio(std::span<const double> base, std::span<const double> next, double fraction = 1);

/// The geometric mean. Throws like ratio_of().
double geometric_mean(std::span<const double> ratios);

/// When pairs are looked at while more of them are being measured, and what each look may spend.
///
/// Who tests again after every round, and stops once there is a difference, finds one sooner or later where
/// there is none. Therefore pairs are looked at after 10, 15, 22, 33, ... of them only, half as many more
/// each time, and the k-th look may err in 1 / (k (k + 1)) of the cases in which a single one might. The
/// shares of all looks, however many there will be, add up to 1, and with them the probabilities to err: p
/// over the share is a p-value, and the interval of that much smaller an error holds the truth, whenever and
/// for whatever reason one stops (a repeated p-value, a repeated confidence interval). Nothing is asked of
/// how looks depend on each other.
///
/// Where the measurement ends between two looks, for a reason that is not in the pairs (a time budget), the
/// next look is taken then. Looks may come at times that were not planned, if what was seen does not decide
/// over them.
///
/// Sources: K. K. G. Lan, D. L. DeMets, Discrete sequential boundaries for clinical trials, Biometrika 70
/// (1983), 659-663 (spending an error over looks); C. Jennison, B. W. Turnbull, Statistical approaches to
/// interim monitoring of medical trials, Statistical Science 5 (1990), 299-317 (repeated p-values and
/// confidence intervals).
struct Look {
  std::size_t pairs;  ///< when it is due
  double fraction;    ///< of the error that a single look might make
};

/// Pairs of the first look. With half of the error ten are the fewest that can be significant at 1 % though
/// one of them, the one that differs least, disagrees.
inline constexpr std::size_t first_look_pairs = 10;

/// The look at so many pairs: the first that is due then or later.
Look look_at(std::size_t pairs);

}  // namespace mssim
