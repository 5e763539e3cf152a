#include "statistics/rank_tests.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "statistics/statistics.h"

namespace mssim {
namespace {

void require_finite(std::span<const double> values) {
  if (values.empty() || !std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
    throw std::invalid_argument("a rank test needs finite values");
}

double normal_below(double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }

/// Ranks of values, from 1; equal values share the mean of their ranks.
struct Midranks {
  std::vector<double> ranks;  ///< [values]
  double tie_term = 0;        ///< the sum of t^3 - t over groups of t equal values: 0 without ties
};

Midranks midranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  Midranks result{std::vector<double>(values.size()), 0};
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    const auto tied = static_cast<double>(end - first);
    for (std::size_t i = first; i < end; ++i)
      result.ranks[order[i]] = static_cast<double>(first + 1 + end) / 2;
    result.tie_term += tied * tied * tied - tied;
  }
  return result;
}

/// The values that a rank test compares: `count` of them, all in [least, most]. They may be too many to
/// store, so `count_up_to(v)` returns how many are at most v.
struct ComparedValues {
  std::size_t count;
  double least, most;
  std::function<std::size_t(double)> count_up_to;
};

/// The rank-th smallest, from 1.
double ranked_value(const ComparedValues& values, std::size_t rank) {
  double low = values.least, high = values.most;
  if (values.count_up_to(low) >= rank) return low;
  // Bisection until no double lies between: then `high`, the smallest that reaches the rank, is the value.
  for (double middle = std::midpoint(low, high); low < middle && middle < high;
       middle = std::midpoint(low, high))
    (values.count_up_to(middle) >= rank ? high : low) = middle;
  return high;
}

/// The median of the values, and the interval that inverts the test with this distribution: from the k-th
/// smallest to the k-th largest value, with error probability `error`.
ShiftEstimate shift_of(const ComparedValues& values, const RankDistribution& distribution, double error) {
  const double upper = ranked_value(values, values.count / 2 + 1);
  ShiftEstimate estimate{upper, values.least, values.most, false};
  if (values.count % 2 == 0) estimate.shift = std::midpoint(ranked_value(values, values.count / 2), upper);
  if (const std::size_t rank = distribution.interval_rank(error); rank > 0) {
    estimate.low = ranked_value(values, rank);
    estimate.high = ranked_value(values, values.count + 1 - rank);
    estimate.covers = true;
  }
  return estimate;
}

}  // namespace

RankDistribution RankDistribution::exact(const std::vector<double>& ways) {
  RankDistribution distribution;
  distribution.at_most_.resize(ways.size());
  std::partial_sum(ways.begin(), ways.end(), distribution.at_most_.begin());
  const double all = distribution.at_most_.back();
  for (double& probability : distribution.at_most_) probability /= all;
  distribution.mean_ = static_cast<double>(ways.size() - 1) / 2;
  return distribution;
}

RankDistribution RankDistribution::normal(double mean, double deviation) {
  RankDistribution distribution;
  distribution.mean_ = mean;
  distribution.deviation_ = deviation;
  return distribution;
}

double RankDistribution::at_most(double statistic) const {
  if (is_exact()) {
    if (statistic < 0) return 0;
    const double last = static_cast<double>(at_most_.size() - 1);
    return at_most_[static_cast<std::size_t>(std::min(std::floor(statistic), last))];
  }
  return deviation_ > 0 ? normal_below((statistic + 0.5 - mean_) / deviation_) : 1;
}

std::size_t RankDistribution::interval_rank(double error) const {
  // Find the first statistic whose tail exceeds that; the mean's tail does.
  std::size_t first = 0, last = static_cast<std::size_t>(mean_);
  while (first < last) {
    const std::size_t middle = std::midpoint(first, last);
    if (at_most(static_cast<double>(middle)) <= error / 2)
      first = middle + 1;
    else
      last = middle;
  }
  return first;
}

RankDistribution rank_sum_distribution(std::size_t x_size, std::size_t y_size) {
  const std::size_t largest = x_size * y_size;
  if (x_size >= exact_below || y_size >= exact_below) {
    const auto pairs = static_cast<double>(largest), all = static_cast<double>(x_size + y_size);
    return RankDistribution::normal(pairs / 2, std::sqrt(pairs * (all + 1) / 12));
  }
  // ways[count][u]: sets of `count` of the ranks so far. The (i+1)-th smallest of x, at rank r from 0, is
  // above r - i values of y.
  std::vector<std::vector<double>> ways(x_size + 1, std::vector<double>(largest + 1));
  ways[0][0] = 1;
  for (std::size_t rank = 0; rank < x_size + y_size; ++rank)
    for (std::size_t count = std::min(rank + 1, x_size); count > 0; --count) {
      const std::size_t below = rank - (count - 1);
      for (std::size_t u = below; u <= largest; ++u) ways[count][u] += ways[count - 1][u - below];
    }
  return RankDistribution::exact(ways[x_size]);
}

RankDistribution signed_rank_distribution(std::size_t size) {
  const std::size_t largest = size * (size + 1) / 2;
  if (size >= exact_below) {
    const auto n = static_cast<double>(size);
    return RankDistribution::normal(n * (n + 1) / 4, std::sqrt(n * (n + 1) * (2 * n + 1) / 24));
  }
  std::vector<double> ways(largest + 1);
  ways[0] = 1;
  for (std::size_t rank = 1; rank <= size; ++rank)
    for (std::size_t sum = largest; sum >= rank; --sum) ways[sum] += ways[sum - rank];
  return RankDistribution::exact(ways);
}

RankTest rank_sum_test(std::span<const double> x, std::span<const double> y) {
  require_finite(x);
  require_finite(y);
  std::vector<double> both(x.begin(), x.end());
  both.insert(both.end(), y.begin(), y.end());
  const Midranks pooled = midranks(both);
  const auto m = static_cast<double>(x.size()), n = static_cast<double>(y.size()), all = m + n;
  const double rank_sum =
      std::accumulate(pooled.ranks.begin(), pooled.ranks.begin() + static_cast<std::ptrdiff_t>(x.size()), 0.);
  RankDistribution distribution = rank_sum_distribution(x.size(), y.size());
  if (pooled.tie_term > 0)
    distribution = RankDistribution::normal(
        m * n / 2, std::sqrt(m * n / 12 * (all + 1 - pooled.tie_term / (all * (all - 1)))));
  const double u = rank_sum - m * (m + 1) / 2;
  return {u, distribution.at_most(u), distribution.at_least(u), distribution.is_exact()};
}

ShiftEstimate rank_sum_shift(std::span<const double> x, std::span<const double> y) {
  const std::vector<double> xs = ascending(x), ys = ascending(y);
  const auto differences_up_to = [&](double bound) {
    // A larger x needs a larger y, so one pass over both samples is enough.
    std::size_t count = 0, first = 0;
    for (const double value : xs) {
      while (first < ys.size() && value - ys[first] > bound) ++first;
      count += ys.size() - first;
    }
    return count;
  };
  return shift_of({xs.size() * ys.size(), xs.front() - ys.back(), xs.back() - ys.front(), differences_up_to},
                  rank_sum_distribution(xs.size(), ys.size()), usual_error);
}

RankTest signed_rank_test(std::span<const double> differences) {
  require_finite(differences);
  std::vector<double> values, sizes;
  for (const double difference : differences)
    if (difference != 0) {
      values.push_back(difference);
      sizes.push_back(std::abs(difference));
    }
  const Midranks ranked = midranks(sizes);
  double v = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] > 0) v += ranked.ranks[i];
  RankDistribution distribution = signed_rank_distribution(values.size());
  if (ranked.tie_term > 0 || values.size() < differences.size()) {
    const auto n = static_cast<double>(values.size());
    distribution = RankDistribution::normal(n * (n + 1) / 4,
                                            std::sqrt(n * (n + 1) * (2 * n + 1) / 24 - ranked.tie_term / 48));
  }
  return {v, distribution.at_most(v), distribution.at_least(v), distribution.is_exact()};
}

ShiftEstimate signed_rank_shift(std::span<const double> differences, double error) {
  const std::vector<double> values = ascending(differences);
  const auto averages_up_to = [&](double bound) {
    // The larger the second value of a pair, the fewer first values keep the average below.
    std::size_t count = 0, firsts = values.size();
    for (std::size_t second = 0; second < values.size(); ++second) {
      while (firsts > 0 && std::midpoint(values[firsts - 1], values[second]) > bound) --firsts;
      count += std::min(firsts, second + 1);
    }
    return count;
  };
  return shift_of({values.size() * (values.size() + 1) / 2, values.front(), values.back(), averages_up_to},
                  signed_rank_distribution(values.size()), error);
}

}  // namespace mssim
