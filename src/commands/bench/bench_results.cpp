#include "commands/bench/bench_results.h"

#include <algorithm>
#include <utility>

#include "bench/results/comparison.h"
#include "commands/bench/earlier_rows.h"
#include "integrators/all_integrators.h"

namespace mssim {
namespace {

std::optional<ResultFolder> folder_of(const BenchPlan& plan) {
  if (plan.output.folder.empty()) return std::nullopt;
  return std::make_optional<ResultFolder>(plan.output.folder, plan.provenance, plan.tables);
}

void add_published_times(std::vector<ResultRow>& rows, const BenchPlan& plan) {
  for (ResultRow& row : rows) {
    const BackendInfo& backend = **std::ranges::find(plan.settings.backends, row.backend, &BackendInfo::name);
    for (const PublishedTable& table : plan.published)
      if (const auto ms = table.ms(find_integrator(row.integrator)->paper_name, backend.paper_configuration,
                                   row.nodes, row.springs_published))
        row.paper_ms = ms;
  }
}

}  // namespace

BenchResults::BenchResults(const BenchPlan& plan)
    : plan_(plan),
      folder_(folder_of(plan)),
      rows_(folder_ ? earlier_rows(*folder_, plan) : std::vector<ResultRow>()) {
  if (folder_) folder_->begin();
}

std::vector<std::string> BenchResults::stems_of_scene(const std::string& name) const {
  std::vector<std::string> stems = file_stems(rows()), of_scene;
  for (std::size_t i = 0; i < stems.size(); ++i)
    if (rows()[i].scene == name) of_scene.push_back(std::move(stems[i]));
  return of_scene;
}

void BenchResults::keep(const std::string& scene, std::vector<ResultRow> rows) {
  require_resumable(differences(of_scene(scene), rows), plan_.output.folder);
  add_published_times(rows, plan_);
  rows_.replace(scene, std::move(rows));
  if (folder_) folder_->write(rows_.all());
}

void BenchResults::keep(const std::vector<StructureRow>& rows) {
  if (folder_) folder_->write(rows);
}

void BenchResults::keep_for_github() const {
  if (folder_) folder_->write_for_github(rows_.all());
}

}  // namespace mssim
