#include "statistics/statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>

#include "statistics/rank_tests.h"

namespace mssim {
namespace {

/// P(B(n, 1/2) = k). By logarithms, because 2^-n underflows a double from n = 1075 on.
double fair_binomial(std::size_t n, std::size_t k) {
  const auto log_factorial = [](std::size_t i) { return std::lgamma(static_cast<double>(i) + 1); };
  return std::exp(log_factorial(n) - log_factorial(k) - log_factorial(n - k) -
                  static_cast<double>(n) * std::numbers::ln2);
}

double middle(const std::vector<double>& sorted) {
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : std::midpoint(sorted[half - 1], sorted[half]);
}

std::vector<double> logarithms(std::span<const double> values) {
  std::vector<double> logs;
  for (const double value : values) {
    if (!(value > 0) || !std::isfinite(value))
      throw std::invalid_argument("a ratio needs finite times above zero");
    logs.push_back(std::log(value));
  }
  if (logs.empty()) throw std::invalid_argument("a ratio needs at least one time");
  return logs;
}

RatioEstimate estimate_of(const ShiftEstimate& shift, const RankTest& test) {
  return {std::exp(shift.shift), std::exp(shift.low), std::exp(shift.high), shift.covers, test.p_two_sided()};
}

/// A place that divides a range of a series, and how much its sides differ: m n / (m + n) times the energy
/// distance of their m and n values.
struct Division {
  std::size_t first = 0;  ///< of the second side
  double divergence = 0;
};

/// The division with the largest divergence. The first side begins with the values; the second one may end
/// before they do, so that a later change does not hide this one. Each side needs two values.
Division best_division(std::span<const double> values) {
  const std::size_t size = values.size();
  // Sums of distances: of all pairs among the first values, by their number; and of each value to all values
  // of the first side.
  std::vector<double> within(size + 1), to_first_side(size);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = i + 1; j < size; ++j) within[j + 1] += std::abs(values[j] - values[i]);
  std::partial_sum(within.begin(), within.end(), within.begin());
  std::vector<double> inverse(size + 1);  // of 1, 2, ..., because divisions would take most of the time
  for (std::size_t i = 1; i <= size; ++i) inverse[i] = 1 / static_cast<double>(i);
  Division best;
  for (std::size_t first = 1; first < size; ++first) {
    const auto m = static_cast<double>(first);
    double across = 0;
    for (std::size_t last = first; last < size; ++last) {
      to_first_side[last] += std::abs(values[last] - values[first - 1]);
      across += to_first_side[last];
      if (first == 1 || last == first) continue;
      const auto n = static_cast<double>(last + 1 - first);
      const double right = within[last + 1] - within[first] - across;
      const double divergence =
          2 * inverse[last + 1] *
          (across - within[first] * n * inverse[first - 1] - right * m * inverse[last - first]);
      if (divergence > best.divergence) best = {first, divergence};
    }
  }
  return best;
}

/// The best division of all parts of a series, which begin at `bounds` and end at the next one.
Division best_of_parts(std::span<const double> values, std::span<const std::size_t> bounds) {
  Division best;
  for (std::size_t part = 0; part + 1 < bounds.size(); ++part) {
    const Division division = best_division(values.subspan(bounds[part], bounds[part + 1] - bounds[part]));
    if (division.divergence > best.divergence) best = {bounds[part] + division.first, division.divergence};
  }
  return best;
}

/// Random orders of a series that a change is tested against. With 499, the fifth largest of 500 divergences,
/// the observed one included, is just significant.
constexpr int random_orders = 499;
/// Random numbers begin with it in every test, so that the same series gives the same changes.
constexpr std::uint64_t order_seed = 1;

/// Whether no more than `change_error` of the random orders, the observed one included, have a division at
/// least as good. Stops when that is decided.
bool is_significant(const Division& observed, std::vector<double> values,
                    std::span<const std::size_t> bounds) {
  constexpr double rounding = 1e-9;
  std::mt19937_64 random(order_seed);
  int as_good = 1;
  for (int order = 0; order < random_orders; ++order) {
    for (std::size_t part = 0; part + 1 < bounds.size(); ++part)
      for (std::size_t i = bounds[part + 1] - 1; i > bounds[part]; --i)
        std::swap(values[i], values[bounds[part] + random() % (i - bounds[part] + 1)]);
    if (best_of_parts(values, bounds).divergence >= (1 - rounding) * observed.divergence) ++as_good;
    if (as_good > change_error * (random_orders + 1)) return false;
  }
  return true;
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

double quantile(std::vector<double> values, double fraction) {
  const auto place =
      values.begin() + std::min(static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size())),
                                std::ssize(values) - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

Quartiles quartiles(std::span<const double> samples) {
  const std::vector<double> sorted = ascending(samples);
  const auto count = static_cast<double>(sorted.size());
  const auto sample_number = [&](double number) {
    const double at = std::clamp(number, 1.0, count) - 1;
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
  };
  return {sample_number((count + 1) / 4), sample_number(3 * (count + 1) / 4)};
}

std::string_view name_of(Outlier outlier) {
  return outlier == Outlier::mild ? "mild" : outlier == Outlier::extreme ? "extreme" : "";
}

std::vector<Outlier> outliers(std::span<const double> samples) {
  const Quartiles middle = quartiles(samples);
  const double range = middle.third - middle.first;
  std::vector<Outlier> labels;
  std::ranges::transform(samples, std::back_inserter(labels), [&](double sample) {
    const double outside = std::max(middle.first - sample, sample - middle.third);
    if (outside > 3 * range) return Outlier::extreme;
    return outside > 1.5 * range ? Outlier::mild : Outlier::no;
  });
  return labels;
}

RatioEstimate ratio_of(std::span<const double> base, std::span<const double> next) {
  const std::vector<double> x = logarithms(next), y = logarithms(base);
  return estimate_of(rank_sum_shift(x, y), rank_sum_test(x, y));
}

RatioEstimate paired_ratio(std::span<const double> base, std::span<const double> next, double fraction) {
  if (base.size() != next.size())
    throw std::invalid_argument("paired ratios need as many times on each side");
  std::vector<double> differences = logarithms(next);
  const std::vector<double> logs = logarithms(base);
  for (std::size_t i = 0; i < logs.size(); ++i) differences[i] -= logs[i];
  RatioEstimate estimate =
      estimate_of(signed_rank_shift(differences, fraction * usual_error), signed_rank_test(differences));
  estimate.p = std::min(1., estimate.p / fraction);
  return estimate;
}

double geometric_mean(std::span<const double> ratios) {
  const std::vector<double> logs = logarithms(ratios);
  return std::exp(std::accumulate(logs.begin(), logs.end(), 0.) / static_cast<double>(logs.size()));
}

std::vector<ChangePoint> change_points(std::span<const double> times) {
  if (times.empty()) return {};
  const std::vector<double> logs = logarithms(times);
  std::vector<std::size_t> bounds{0, logs.size()};
  for (;;) {
    const Division best = best_of_parts(logs, bounds);
    if (best.first == 0 || !is_significant(best, logs, bounds)) break;
    bounds.insert(std::ranges::upper_bound(bounds, best.first), best.first);
  }
  std::vector<ChangePoint> changes;
  for (std::size_t i = 1; i + 1 < bounds.size(); ++i)
    changes.push_back({bounds[i], ratio_of(times.subspan(bounds[i - 1], bounds[i] - bounds[i - 1]),
                                           times.subspan(bounds[i], bounds[i + 1] - bounds[i]))});
  return changes;
}

Look look_at(std::size_t pairs) {
  std::size_t due = first_look_pairs, number = 1;
  for (; due < pairs; due += due / 2) ++number;
  return {due, 1 / static_cast<double>(number * (number + 1))};
}

}  // namespace mssim
