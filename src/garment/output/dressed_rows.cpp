#include "garment/output/dressed_rows.h"

#include <set>
#include <string_view>

namespace mssim {

std::vector<const ResultRow*> rows_of_dressed_scenes(std::span<const ResultRow> rows) {
  std::set<std::string_view> scenes;
  for (const ResultRow& row : rows)
    if (row.dressing) scenes.insert(row.scene);
  std::vector<const ResultRow*> found;
  for (const ResultRow& row : rows)
    if (scenes.contains(row.scene)) found.push_back(&row);
  return found;
}

std::optional<double> ms_per_iteration(const DressingRecord& dressing) {
  if (dressing.iterations == 0) return std::nullopt;
  return 1e3 * dressing.wall_s / static_cast<double>(dressing.iterations);
}

}  // namespace mssim
