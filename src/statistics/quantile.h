#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace mssim {

/// The value that a share (0 to 1) of the values lie below: one of them, which is not interpolated; 1 is the
/// largest. There is one value at least.
inline double quantile(std::vector<double> values, double fraction) {
  const auto place =
      values.begin() + std::min(static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size())),
                                std::ssize(values) - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace mssim
