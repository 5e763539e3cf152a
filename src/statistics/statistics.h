#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace mssim {

/// The median of a sample and an interval for the median of its distribution, in the sample's unit.
struct MedianInterval {
  double median = 0;
  double low = 0;   ///< a sample
  double high = 0;  ///< a sample
  /// Probability that such an interval contains the true median: at least 0.95 from 6 samples on. Fewer
  /// samples have no 95 % interval; then low and high are the smallest and the largest sample, and this is
  /// their coverage (2 samples: 0.5, 5 samples: 0.9375).
  double coverage = 0;
};

/// Minimum coverage of [low, high] of a MedianInterval, if the number of samples allows it.
inline constexpr double interval_confidence = 0.95;

/// Probability that the median of a distribution lies between the rank-th smallest and the rank-th largest of
/// `samples` independent draws. The number of draws below the median is binomial with p = 1/2, so this is
///     1 - 2 P(B(samples, 1/2) < rank),
/// whatever the distribution, if it is continuous; draws that can tie make it a lower bound.
/// Source: H. A. David, H. N. Nagaraja, Order Statistics, 3rd ed., Wiley 2003, section 7.1.
/// `rank` counts from 1 and is at most (samples + 1) / 2; 0 covers everything.
double rank_coverage(std::size_t samples, std::size_t rank);

/// The largest rank whose interval still covers 95 %: the narrowest such symmetric interval; 0 if there is
/// none (fewer than 6 samples). The binomial distribution is discrete, so the coverage is often well above 95
/// %; nothing is interpolated.
std::size_t interval_rank(std::size_t samples);

/// The samples in ascending order. Throws std::invalid_argument for no samples or for one that is not finite.
std::vector<double> ascending(std::span<const double> samples);

/// The middle sample, or the mean of the two middle ones. Throws like ascending().
double median(std::span<const double> samples);

/// Mean, and the distribution's standard deviation as estimated from the sample (division by n - 1), for
/// formats that require them: unlike the median, both follow outliers.
struct MeanDeviation {
  double mean = 0;
  double deviation = 0;  ///< 0 for a single sample
};
/// Throws std::invalid_argument for no samples.
MeanDeviation mean_deviation(std::span<const double> samples);

/// The median of the samples with its interval. Throws like median().
MedianInterval median_interval(std::span<const double> samples);

/// The median of numerator[round] / denominator[round], with its interval. The ratio is taken per round: a
/// disturbance of one round affects both of its samples and cancels. Throws like median(), and
/// std::invalid_argument for unequal lengths.
MedianInterval median_ratio(std::span<const double> numerators, std::span<const double> denominators);

/// The `fraction` quantile (0 to 1): one of the values, not interpolated; 1 gives the largest. Needs at least
/// one value.
double quantile(std::vector<double> values, double fraction);

/// First and third quartile: the samples number p (n + 1), p = 1/4 and 3/4, counted from 1 in ascending
/// order, interpolated and limited to the range of the samples. Source: NIST/SEMATECH e-Handbook of
/// Statistical Methods, section 7.1.6.
struct Quartiles {
  double first = 0;
  double third = 0;
};
/// Throws std::invalid_argument for no samples or for one that is not finite.
Quartiles quartiles(std::span<const double> samples);

/// Whether a sample is an outlier.
enum class Outlier : std::uint8_t { no, mild, extreme };

/// "", "mild" or "extreme".
std::string_view name_of(Outlier outlier);

/// A label for every sample: mild beyond the inner fences, 1.5 interquartile ranges outside the quartiles;
/// extreme beyond the outer ones, 3 ranges. Informational only: outliers are never excluded. Source: J. W.
/// Tukey, Exploratory Data Analysis, Addison-Wesley 1977. Throws like quartiles().
std::vector<Outlier> outliers(std::span<const double> samples);

/// A ratio of two times, estimated on logarithms: there a factor is a shift, and both times are treated
/// alike.
struct RatioEstimate {
  double ratio = 1;
  double low = 1, high = 1;  ///< the 95 % interval
  bool covers = false;  ///< whether there are enough samples for one; if not, they are the extreme ratios
  double p = 1;         ///< two-sided: of ranks that differ this much if there is no difference
};

/// next / base of two independent samples of times: rank_sum_shift() and rank_sum_test() (rank_tests.h) of
/// the logarithms. Throws std::invalid_argument for an empty sample or a time that is not finite and
/// positive.
RatioEstimate ratio_of(std::span<const double> base, std::span<const double> next);

/// next[i] / base[i] of pairs: signed_rank_shift() and signed_rank_test(). `fraction` is the share of their
/// error that this estimate may spend if it is one of several (Look): the interval's error is fraction times
/// 5 %, and p is the test's p over the fraction. Throws like ratio_of(), and for samples of unequal length.
RatioEstimate paired_ratio(std::span<const double> base, std::span<const double> next, double fraction = 1);

/// The geometric mean. Throws like ratio_of().
double geometric_mean(std::span<const double> ratios);

/// A place in a series of times from which on they are others.
struct ChangePoint {
  std::size_t first = 0;  ///< the first time after the change
  /// The times from it to the next change, over those before it from the previous one on: ratio_of(). Its
  /// interval takes the place of the change as known.
  RatioEstimate ratio;
};

/// Probability that change_points() finds a change in a series without one, or one more than there are.
inline constexpr double change_error = 0.01;

/// The changes of a series of times, in its order: E-divisive means, on logarithms. The place that divides a
/// part of the series best, by the energy distance of what is before it and of what follows up to some later
/// place, is a change if at most `change_error` of
/// random orders have a place that divides them as well. All parts are searched again until none has one. A
/// random order shuffles each part between known changes, so the test needs no distribution of the times. It
/// needs that all orders are equally likely without a change: a trend counts as changes. The same series
/// gives the same changes.
///
/// Sources: D. S. Matteson, N. A. James, A nonparametric approach for multiple change point analysis of
/// multivariate data, Journal of the American Statistical Association 109 (2014), 334-345, with exponent 1;
/// D. Daly et al., The use of change point detection
/// to identify software performance regressions in a continuous integration system, ICPE 2020, 67-75, do so
/// with the times of commits. Throws std::invalid_argument for a time that is not finite and positive.
std::vector<ChangePoint> change_points(std::span<const double> times);

/// When pairs are tested while more are being measured, and how much error each test may spend.
///
/// Testing after every round and stopping at the first significant result inflates the false-positive rate.
/// Therefore pairs are tested only after 10, 15, 22, 33, ... of them, half as many more each time, and the
/// k-th look may spend the fraction 1 / (k (k + 1)) of a single test's error. The fractions of all looks,
/// however many there will be, add up to 1, and so do the error probabilities: p over the fraction is a
/// p-value, and the interval with the error times the fraction is valid, whenever and for whatever reason the
/// measurement stops (a repeated p-value, a repeated confidence interval). Looks may depend on each other in
/// any way.
///
/// If the measurement ends between two looks, for a reason independent of the pairs (a time budget), the next
/// look is taken then. Looks may come at unplanned times, if these do not depend on the results.
///
/// Sources: K. K. G. Lan, D. L. DeMets, Discrete sequential boundaries for clinical trials, Biometrika 70
/// (1983), 659-663 (spending an error over looks); C. Jennison, B. W. Turnbull, Statistical approaches to
/// interim monitoring of medical trials, Statistical Science 5 (1990), 299-317 (repeated p-values and
/// confidence intervals).
struct Look {
  std::size_t pairs;  ///< number of pairs at which it is due
  double fraction;    ///< of a single test's error
};

/// Pairs of the first look. With half of the error, ten are the fewest that can be significant at 1 %
/// although one of them, the one with the smallest difference, disagrees.
inline constexpr std::size_t first_look_pairs = 10;

/// The look at `pairs` pairs: the first one due at that number or later.
Look look_at(std::size_t pairs);

}  // namespace mssim
