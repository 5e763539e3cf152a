#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "application/bench/bench_plan.h"
#include "bench/job/job.h"
#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "output/folders/result_folder.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// The rows of a bench: what an earlier run left, and what is measured now.
class BenchRows {
 public:
  explicit BenchRows(std::vector<ResultRow> earlier) : rows_(std::move(earlier)) {}

  const std::vector<ResultRow>& all() const { return rows_; }
  std::vector<ResultRow> of_scene(const std::string& name) const;
  /// Puts `rows` where the scene's rows were, or at the end.
  void replace(const std::string& scene, std::vector<ResultRow> rows);

 private:
  std::vector<ResultRow> rows_;
};

/// Whether an earlier run finished all that the settings ask for of a scene. Throws UsageError when it
/// measured other combinations of it: samples of one row are compared with those of the others round by
/// round.
bool is_finished(const BenchSettings& settings, const std::string& scene,
                 const std::vector<ResultRow>& earlier);

/// What `mssim bench --out` left in a folder.
struct MeasuredRun {
  Provenance provenance;
  std::vector<ResultRow> rows;  ///< those that are ok have samples
};

/// Reads a result folder, named by itself or by a file in it. Throws UsageError when there is none or its
/// samples are not those of its rows, CsvError and ProvenanceError for files that cannot be read.
MeasuredRun read_run(const std::filesystem::path& path);

/// The rows of a result folder that were verified by the very program that runs now (the same bytes), on the
/// same machine, for the same threads, devices and scenes; whatever of them failed there stays failed. Throws
/// UsageError where it is not so, and what reading them throws. `now`: with the scenes.
std::vector<ResultRow> verified_rows(const std::string& folder, const Provenance& now);

/// Throws UsageError where these rows of a folder leave out a combination of the scene.
void require_rows(const std::vector<ResultRow>& verified, const std::string& scene,
                  const BenchSettings& settings, const std::string& folder);

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
