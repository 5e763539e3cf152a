#pragma once

#include <span>
#include <vector>

namespace mssim {

/// The ranks of values, from 1; equal ones share the mean of theirs.
struct Midranks {
  std::vector<double> ranks;  ///< [values]
  double tie_term = 0;        ///< the sum of t^3 - t over groups of t equal values: 0 without ties
};
Midranks midranks(std::span<const double> values);

}  // namespace mssim
