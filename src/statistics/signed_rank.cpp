#include "statistics/signed_rank.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "statistics/midranks.h"
#include "statistics/rank_distribution.h"

namespace mssim {
namespace {

void require_differences(std::span<const double> values) {
  if (values.empty() || !std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
    throw std::invalid_argument("signed ranks need finite values");
}

}  // namespace

RankTest signed_rank_test(std::span<const double> differences) {
  require_differences(differences);
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
  require_differences(differences);
  std::vector<double> values(differences.begin(), differences.end());
  std::ranges::sort(values);
  const auto averages_up_to = [&](double bound) {
    // The larger the second of a pair, the fewer firsts keep the average down.
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
