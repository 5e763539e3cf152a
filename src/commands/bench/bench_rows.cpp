#include "commands/bench/bench_rows.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "text/error.h"

namespace mssim {

std::vector<ResultRow> BenchRows::of_scene(const std::string& name) const {
  std::vector<ResultRow> rows;
  std::ranges::copy_if(rows_, std::back_inserter(rows),
                       [&](const ResultRow& row) { return row.scene == name; });
  return rows;
}

void BenchRows::replace(const std::string& scene, std::vector<ResultRow> rows) {
  const auto first = std::ranges::find(rows_, scene, &ResultRow::scene);
  const auto at =
      rows_.insert(first, std::make_move_iterator(rows.begin()), std::make_move_iterator(rows.end()));
  const auto behind = at + static_cast<std::ptrdiff_t>(rows.size());
  rows_.erase(std::remove_if(behind, rows_.end(), [&](const ResultRow& row) { return row.scene == scene; }),
              rows_.end());
}

bool is_finished(const BenchSettings& settings, const std::string& scene,
                 const std::vector<ResultRow>& earlier) {
  if (earlier.empty()) return false;
  std::set<std::pair<std::string, std::string>> asked, measured;
  for (const Integrator* integrator : settings.integrators)
    for (const BackendInfo* backend : settings.backends) asked.emplace(backend->name, integrator->name);
  for (const ResultRow& row : earlier) measured.emplace(row.backend, row.integrator);
  if (asked != measured)
    throw UsageError("the folder has other backends or integrators of " + scene +
                     " than this command: --resume needs the same ones; choose another --out, "
                     "or --overwrite to measure anew");
  return std::ranges::all_of(
      earlier, [&](const ResultRow& row) { return row.status != "ok" || row.rounds >= settings.rounds; });
}

}  // namespace mssim
