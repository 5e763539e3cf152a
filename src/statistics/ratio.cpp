#include "statistics/ratio.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "statistics/rank_sum.h"
#include "statistics/signed_rank.h"

namespace mssim {
namespace {

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

}  // namespace

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

}  // namespace mssim
