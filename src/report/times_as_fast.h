#pragma once

#include <optional>
#include <span>

#include "bench/results/result.h"

namespace mssim {

/// A ratio and its interval.
struct RatioInterval {
  double ratio = 1;
  double low = 1, high = 1;
};

/// How many times as fast as `than` a row is: the median of the ratios within each round, with its 95 %
/// interval (statistics.h). Where their samples are no pairs: the quotient of the times, and of the ends of
/// their intervals, which is wider. None where one of them does not count.
std::optional<RatioInterval> times_as_fast(const ResultRow& row, const ResultRow& than);

/// 1 where the interval lies above 1, -1 where it lies below, and 0 where it holds 1.
int side_of_one(const RatioInterval& interval);

/// The exponent p of y ~ x^p: the slope of the line of least squares on logarithmic axes. None for fewer than
/// two different x. All are above zero.
std::optional<double> exponent_of(std::span<const double> x, std::span<const double> y);

}  // namespace mssim
