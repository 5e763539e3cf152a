#include "statistics/rank_distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace mssim {
namespace {

double normal_below(double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }

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
  // The first statistic whose tail is more than that, which the mean's is.
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
  // ways[count][u]: sets of `count` of the ranks so far. The (i+1)-th smallest of x, at rank r counted from
  // 0, stands above r - i of y.
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

}  // namespace mssim
