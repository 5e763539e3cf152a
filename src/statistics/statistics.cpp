#include "statistics/statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace mssim {
namespace {

/// P(B(n, 1/2) = k). By logarithms, because 2^-n is no double from n = 1075 on.
double fair_binomial(std::size_t n, std::size_t k) {
  const auto log_factorial = [](std::size_t i) { return std::lgamma(static_cast<double>(i) + 1); };
  return std::exp(log_factorial(n) - log_factorial(k) - log_factorial(n - k) -
                  static_cast<double>(n) * std::numbers::ln2);
}

double middle(const std::vector<double>& sorted) {
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : std::midpoint(sorted[half - 1], sorted[half]);
}

}  // namespace

std::vector<double> ascending(std::span<const double> samples) {
  if (samples.empty()) throw std::invalid_argument("statistics need at least one sample");
  std::vector<double> result(samples.begin(), samples.end());
  if (!std::all_of(result.begin(), result.end(), [](double sample) { return std::isfinite(sample); }))
    throw std::invalid_argument("statistics need finite samples");
  std::sort(result.begin(), result.end());
  return result;
}

double rank_coverage(std::size_t samples, std::size_t rank) {
  double tail = 0;
  for (std::size_t k = 0; k < rank; ++k) tail += fair_binomial(samples, k);
  return 1 - 2 * tail;
}

std::size_t interval_rank(std::size_t samples) {
  std::size_t rank = 0;
  for (double tail = fair_binomial(samples, 0); 1 - 2 * tail >= interval_confidence;
       tail += fair_binomial(samples, rank))
    ++rank;
  return rank;
}

double median(std::span<const double> samples) { return middle(ascending(samples)); }

MeanDeviation mean_deviation(std::span<const double> samples) {
  if (samples.empty()) throw std::invalid_argument("a mean needs at least one sample");
  const auto count = static_cast<double>(samples.size());
  const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / count;
  if (samples.size() == 1) return {mean, 0};
  const double squares =
      std::transform_reduce(samples.begin(), samples.end(), 0.0, std::plus<>(),
                            [&](double sample) { return (sample - mean) * (sample - mean); });
  return {mean, std::sqrt(squares / (count - 1))};
}

MedianInterval median_interval(std::span<const double> samples) {
  const std::vector<double> sorted = ascending(samples);
  const std::size_t rank = std::max<std::size_t>(interval_rank(sorted.size()), 1);
  return {middle(sorted), sorted[rank - 1], sorted[sorted.size() - rank], rank_coverage(sorted.size(), rank)};
}

MedianInterval median_ratio(std::span<const double> numerators, std::span<const double> denominators) {
  if (numerators.size() != denominators.size())
    throw std::invalid_argument("a ratio per round needs as many numerators as denominators");
  std::vector<double> ratios(numerators.size());
  std::transform(numerators.begin(), numerators.end(), denominators.begin(), ratios.begin(),
                 [](double numerator, double denominator) { return numerator / denominator; });
  return median_interval(ratios);
}

}  // namespace mssim
