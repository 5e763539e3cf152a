#include "report/times_as_fast.h"

#include <cmath>

#include "statistics/statistics.h"

namespace mssim {

std::optional<RatioInterval> times_as_fast(const ResultRow& row, const ResultRow& than) {
  if (!counts(row) || !counts(than)) return std::nullopt;
  if (!row.samples_ms.empty() && row.samples_ms.size() == than.samples_ms.size()) {
    const MedianInterval ratio = median_ratio(than.samples_ms, row.samples_ms);
    return RatioInterval{ratio.median, ratio.low, ratio.high};
  }
  if (!row.ms_per_step || !than.ms_per_step) return std::nullopt;
  const auto end = [](const ResultRow& of, std::optional<double> ResultRow::*value) {
    return (of.*value).value_or(*of.ms_per_step);
  };
  return RatioInterval{*than.ms_per_step / *row.ms_per_step,
                       end(than, &ResultRow::ms_per_step_low) / end(row, &ResultRow::ms_per_step_high),
                       end(than, &ResultRow::ms_per_step_high) / end(row, &ResultRow::ms_per_step_low)};
}

int side_of_one(const RatioInterval& interval) { return interval.low > 1 ? 1 : interval.high < 1 ? -1 : 0; }

std::optional<double> exponent_of(std::span<const double> x, std::span<const double> y) {
  double mean_x = 0, mean_y = 0, across = 0, along = 0;
  const auto count = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / count;
    mean_y += std::log(y[i]) / count;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x;
    across += dx * (std::log(y[i]) - mean_y);
    along += dx * dx;
  }
  if (!(along > 0)) return std::nullopt;
  return across / along;
}

}  // namespace mssim
