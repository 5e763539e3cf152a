#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "output/tables/results.h"
#include "platform/files.h"

namespace mssim {

/// Files of a result folder: times, samples, the dressing of garments, the provenance, and the times as other
/// programs read them.
inline constexpr const char *timings_name = "timings.csv", *samples_name = "samples.csv",
                            *garment_name = "garment.csv", *provenance_name = "provenance.json",
                            *benchmark_name = "benchmark.json", *github_name = "github.json";
/// Subfolder with the output of programs that are backends, one file per row, named by file_stems() and .txt.
inline constexpr const char* programs_name = "programs";
/// Subfolder with the traces of a bench, of each row one named by file_stems() and .h5, and its .xdmf.
inline constexpr const char* traces_name = "traces";
/// The option with which a bench writes them; in the command of its provenance.
inline constexpr std::string_view trace_option = "--trace";

/// Names of each row's files without extension: SCENE-BACKEND-INTEGRATOR, with _ in the place of characters
/// that no trace may have in its name. If an earlier row has that name, or it is too long or not a valid file
/// name, it is shortened and ends in a hash of the three.
std::vector<std::string> file_stems(std::span<const ResultRow> rows);

/// The results of one run of `mssim bench`: timings.csv, samples.csv, garment.csv for garments,
/// benchmark.json, provenance.json, output of programs that are backends, and tables derived from the rows,
/// as NAME.csv and NAME.md. A folder of `mssim guide` has provenance.json and tables. Holds an exclusive
/// lock: one writer at a time.
class ResultFolder {
 public:
  /// Creates the folder and its parents. Throws WriteError, also if another ResultFolder, in any process, has
  /// the folder.
  ResultFolder(std::filesystem::path folder, Provenance provenance, TableMaker tables);

  /// Whether an earlier run left rows here.
  bool has_rows() const;
  /// Whether the folder has a file of a name that a run writes, except the provenance of a run that was ended
  /// before it had a row.
  bool has_results() const;
  /// Throws UsageError if a file that these rows may write below programs/ or traces/ is there and not of an
  /// earlier run, or, `with_traces`, if traces/ is a link.
  void require_free(std::span<const ResultRow> rows, bool with_traces) const;
  /// Makes the first write replace the results of an earlier run, including its provenance. They stay until
  /// then.
  void replace_results() { replaces_ = true; }
  /// Adds the start of the run whose rows stay to this run's provenance, which replaces that run's with the
  /// first new rows.
  void go_on_with(const Provenance& earlier);
  /// Writes provenance.json, or only tests writing if an earlier run's stays for now. So a folder that cannot
  /// be written is found before anything is measured. Throws WriteError.
  void begin() const;

  /// Writes all files that follow from the rows, each whole or not at all, and timings.csv last, so that its
  /// rows have their samples; github.json only if the folder has one. Call it after every round. Throws
  /// WriteError; throws std::invalid_argument for a number that is not finite, before any file is touched.
  void write(std::span<const ResultRow> rows);

  /// Writes github.json (github_table()). Throws WriteError.
  void write_for_github(std::span<const ResultRow> rows) const;

  /// Writes tables that do not come from rows, as NAME.csv and, if there is a page, NAME.md. Throws
  /// WriteError.
  void write(std::span<const ResultTable> tables);

 private:
  /// Writes everything under temporary names to the disk before any file is replaced, except `programs`.
  void write_files(std::vector<FolderFile> files, const std::vector<FolderFile>& programs = {});
  /// What the earlier run's rows have below programs/ and traces/: outputs of its programs, and traces if it
  /// wrote any. Nothing if these are links.
  std::vector<std::string> files_of_rows() const;
  void clear() const;

  std::filesystem::path folder_;
  Descriptor lock_;  ///< of the folder
  Provenance provenance_;
  TableMaker tables_;
  bool replaces_ = false, goes_on_ = false;  ///< until the first write
};

/// Removes samples of rounds that a row does not have: a run that was ended between two files leaves a round
/// that timings.csv, the last one, lacks.
void keep_rounds_of_timings(std::span<ResultRow> rows);

/// The rows that an earlier run left in a folder, with their samples and dressings; none without timings.csv.
/// Throws CsvError.
std::vector<ResultRow> read_results(const std::filesystem::path& folder);

}  // namespace mssim
