#include "backends/layouts/springs_by_first_end.h"

#include <numeric>

namespace mssim {

SpringsByFirstEnd::SpringsByFirstEnd(std::span<const Spring> springs, std::span<const std::uint32_t> slot,
                                     std::span<const std::uint32_t> rank)
    : slot_(slot), rank_(rank), begin_(slot.size() + 1, 0), order_(springs.size()) {
  for (const Spring& spring : springs) ++begin_[first_slot(spring) + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t s = 0; s < springs.size(); ++s) order_[next[first_slot(springs[s])]++] = s;
}

}  // namespace mssim
