#include "statistics/rank_sum.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "statistics/midranks.h"
#include "statistics/rank_distribution.h"
#include "statistics/statistics.h"

namespace mssim {
namespace {

void require_samples(std::span<const double> values) {
  if (values.empty() || !std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
    throw std::invalid_argument("a rank sum needs finite values in both samples");
}

}  // namespace

RankTest rank_sum_test(std::span<const double> x, std::span<const double> y) {
  require_samples(x);
  require_samples(y);
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
  require_samples(x);
  require_samples(y);
  const std::vector<double> xs = ascending(x), ys = ascending(y);
  const auto differences_up_to = [&](double bound) {
    // A larger x needs a larger y, so that both samples are passed once.
    std::size_t count = 0, first = 0;
    for (const double value : xs) {
      while (first < ys.size() && value - ys[first] > bound) ++first;
      count += ys.size() - first;
    }
    return count;
  };
  return shift_of({xs.size() * ys.size(), xs.front() - ys.back(), xs.back() - ys.front(), differences_up_to},
                  rank_sum_distribution(xs.size(), ys.size()));
}

}  // namespace mssim
