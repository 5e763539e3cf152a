#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "application/bench/bench_plan.h"
#include "bench/job/job.h"
#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "output/folders/result_folder.h"

namespace mssim {

/// The rows of a scene among those of a bench.
std::vector<ResultRow> rows_of_scene(const std::vector<ResultRow>& rows, const std::string& scene);

/// Replaces the rows of a scene, where they stand, by `its`, or appends these.
void replace_rows(std::vector<ResultRow>& rows, const std::string& scene, std::vector<ResultRow> its);

/// Whether an earlier run into `folder` completed every requested combination of the scene, with frames and
/// the check of its samples. Throws UsageError if it measured other combinations, because samples of
/// different rows are compared round by round.
bool is_finished(const BenchSettings& settings, const std::string& scene,
                 const std::vector<ResultRow>& earlier, const std::string& folder);

/// The content of a folder written by `mssim bench --out`.
struct MeasuredRun {
  Provenance provenance;
  std::vector<ResultRow> rows;  ///< those with status ok have samples
};

/// Reads a result folder, given as its path or the path of a file in it. Throws UsageError if there is none
/// or its samples do not match its rows, or a number is no time (is_time); CsvError and ProvenanceError for
/// files that cannot be read.
MeasuredRun read_run(const std::filesystem::path& path);

/// The rows of a result folder that were verified by the same program (to the byte), on the same machine,
/// with the same threads, devices and scenes. Rows that failed there stay failed. Throws UsageError if the
/// folder does not match, and the errors of reading it. `now`: with the scenes.
std::vector<ResultRow> verified_rows(const std::string& folder, const Provenance& now);

/// Tells on stderr how many rows that count, if any, have samples that nothing has checked, because their run
/// was ended before that. `folder`: where they are; empty: in memory.
void tell_unchecked_samples(std::span<const ResultRow> rows, const std::string& folder);

/// Throws UsageError if these rows of a folder lack a combination of the scene, or its samples are not
/// checked.
void require_rows(const std::vector<ResultRow>& verified, const std::string& scene,
                  const BenchSettings& settings, const std::string& folder);

/// Results of a bench, with those of an earlier run, in the plan's folder if it has one.
class BenchResults {
 public:
  /// Opens the folder with the rows that are to stay. `plan` must outlive this. Throws like earlier_rows and
  /// ResultFolder.
  explicit BenchResults(const BenchPlan& plan);

  const std::vector<ResultRow>& rows() const { return rows_; }
  std::vector<ResultRow> of_scene(const std::string& name) const { return rows_of_scene(rows_, name); }
  /// The plan's folder, if it has one.
  std::optional<ResultFolder>& folder() { return folder_; }
  const std::optional<ResultFolder>& folder() const { return folder_; }
  /// The names of the files of the scene's rows (file_stems), unique among those of all scenes.
  std::vector<std::string> stems_of_scene(const std::string& name) const;

  /// Replaces the rows of a scene, adds the published times, and writes the folder. Throws UsageError if they
  /// are not comparable with those of an earlier run, and WriteError.
  void keep(const std::string& scene, std::vector<ResultRow> rows);

 private:
  const BenchPlan& plan_;
  std::optional<ResultFolder> folder_;
  std::vector<ResultRow> rows_;  ///< of an earlier run, and of this one
};

}  // namespace mssim
