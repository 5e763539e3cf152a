#include "charts/series_style.h"

#include <algorithm>
#include <map>
#include <string>

namespace mssim {

std::vector<SeriesStyle> series_styles(std::span<const Series> series, std::span<const std::string> fixed) {
  std::vector<SeriesStyle> styles;
  std::map<std::string, std::size_t> families;
  std::size_t next = 0, next_reference = 0;
  for (const std::string& family : fixed) families.try_emplace(family, next++);
  for (const Series& one : series) {
    if (one.origin == Origin::reference) {
      styles.push_back({one.mark == PointMark::none ? next_reference++ : 0, one.origin});
      continue;
    }
    const auto known = families.find(one.family);
    const bool is_free =
        known != families.end() && std::ranges::none_of(styles, [&](const SeriesStyle& style) {
          return style.family == known->second && style.origin == one.origin;
        });
    const std::size_t family = is_free ? known->second : next++;
    if (!one.family.empty()) families.try_emplace(one.family, family);
    styles.push_back({family, one.origin});
  }
  return styles;
}

}  // namespace mssim
