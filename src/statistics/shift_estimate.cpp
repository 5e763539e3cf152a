#include "statistics/shift_estimate.h"

#include <numeric>

namespace mssim {
namespace {

/// The rank-th smallest, from 1.
double ranked_value(const ComparedValues& values, std::size_t rank) {
  double low = values.least, high = values.most;
  if (values.count_up_to(low) >= rank) return low;
  // Halved until no number lies between: then `high` is the smallest that reaches the rank, so the value.
  for (double middle = std::midpoint(low, high); low < middle && middle < high;
       middle = std::midpoint(low, high))
    (values.count_up_to(middle) >= rank ? high : low) = middle;
  return high;
}

}  // namespace

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

}  // namespace mssim
