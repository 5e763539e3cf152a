#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace mssim {

/// Items by group, in two arrays. Within a group they keep the order in which they were given.
template <class Item, class Index = std::uint32_t>
struct Grouped {
  std::vector<Index> first{0};  ///< [groups + 1] begin of each group in `items`
  std::vector<Item> items;      ///< group by group

  Grouped() = default;
  /// A counting sort. for_each(visit) calls visit(group, item) for every item. It is called twice, and must
  /// give the same both times.
  template <class ForEach>
  Grouped(std::size_t groups, const ForEach& for_each) : first(groups + 1, 0) {
    for_each([&](std::size_t group, const Item& /*item*/) { ++first[group + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    items.resize(first.back());
    std::vector<Index> next(first.begin(), first.end() - 1);
    for_each([&](std::size_t group, const Item& item) { items[next[group]++] = item; });
  }

  std::size_t groups() const { return first.size() - 1; }
  std::span<const Item> of(std::size_t group) const {
    return std::span(items).subspan(first[group], first[group + 1] - first[group]);
  }
};

}  // namespace mssim
