#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <vector>

namespace mssim {

/// Gives things of these weights to so many ranks: the heaviest first, each to the rank with the least so far
/// (Graham 1969, LPT), which is at most 4/3 of what the best way gives the rank with most. [things] the rank
/// of each.
inline std::vector<int> ranks_by_weight(const std::vector<std::size_t>& weights, int ranks) {
  std::vector<std::size_t> order(weights.size()), load(static_cast<std::size_t>(ranks), 0);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return weights[i]; });
  std::vector<int> rank_of(weights.size());
  for (const std::size_t i : order) {
    const auto least = std::ranges::min_element(load);
    *least += weights[i];
    rank_of[i] = static_cast<int>(least - load.begin());
  }
  return rank_of;
}

}  // namespace mssim
