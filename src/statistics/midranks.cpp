#include "statistics/midranks.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace mssim {

Midranks midranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  Midranks result{std::vector<double>(values.size()), 0};
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    const auto tied = static_cast<double>(end - first);
    for (std::size_t i = first; i < end; ++i)
      result.ranks[order[i]] = static_cast<double>(first + 1 + end) / 2;
    result.tie_term += tied * tied * tied - tied;
  }
  return result;
}

}  // namespace mssim
