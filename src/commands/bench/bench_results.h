#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/results/result.h"
#include "commands/bench/bench_plan.h"
#include "commands/bench/bench_rows.h"
#include "output/folders/result_folder.h"

namespace mssim {

/// The results of a bench, what an earlier run left among them, in the plan's folder where there is one.
class BenchResults {
 public:
  /// Takes the folder, with what of it is to stay. `plan` must outlive it. Throws like earlier_rows and
  /// ResultFolder.
  explicit BenchResults(const BenchPlan& plan);

  const std::vector<ResultRow>& rows() const { return rows_.all(); }
  std::vector<ResultRow> of_scene(const std::string& name) const { return rows_.of_scene(name); }
  /// The names of the files of these rows (file_stems), among those of all scenes.
  std::vector<std::string> stems_of_scene(const std::string& name) const;

  /// Takes the rows of a scene in place of those that it had, adds the published times, and writes the
  /// folder. Throws UsageError where they are not comparable with what an earlier run left, and WriteError.
  void keep(const std::string& scene, std::vector<ResultRow> rows);
  /// Writes what scenes are. Throws WriteError.
  void keep(const std::vector<StructureRow>& rows);
  /// Writes what github-action-benchmark reads. Throws WriteError.
  void keep_for_github() const;

 private:
  const BenchPlan& plan_;
  std::optional<ResultFolder> folder_;
  BenchRows rows_;
};

}  // namespace mssim
