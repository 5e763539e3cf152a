#pragma once

#include <cstddef>
#include <functional>

#include "statistics/rank_distribution.h"

namespace mssim {

/// An estimate of how far values are shifted, by the rank test that belongs to it.
struct ShiftEstimate {
  double shift = 0;          ///< Hodges and Lehmann's: the median of what the test compares
  double low = 0, high = 0;  ///< the interval, of 95 % unless another error was asked for
  /// Whether the samples are large enough for such an interval. Else low and high are the outermost values.
  bool covers = false;
};

/// What a rank test compares: so many values, all in [least, most]; they may be too many to be written down,
/// therefore `count_up_to(v)` says how many of them are at most v.
struct ComparedValues {
  std::size_t count;
  double least, most;
  std::function<std::size_t(double)> count_up_to;
};

/// Their median, and the interval that inverts the test whose statistic is so distributed: from the k-th
/// smallest to the k-th largest of them, which misses in `error` of the cases.
ShiftEstimate shift_of(const ComparedValues& values, const RankDistribution& distribution,
                       double error = usual_error);

}  // namespace mssim
