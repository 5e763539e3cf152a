#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "output/tables/results.h"
#include "output/tables/suite_tables.h"
#include "platform/files.h"

namespace mssim {

/// Files of a result folder: times, samples, and dressings of garments.
inline constexpr const char *timings_name = "timings.csv", *samples_name = "samples.csv",
                            *garment_name = "garment.csv";
/// Its folder of what programs that are backends wrote, a file a row, named by file_stems() and .txt.
inline constexpr const char* programs_name = "programs";

/// For each row SCENE-BACKEND-INTEGRATOR, the name of its files without an extension. Where an earlier row
/// has that name, or it is too long for a file or not the name of one, it is shortened and ends in a hash of
/// the three.
std::vector<std::string> file_stems(std::span<const ResultRow> rows);

/// A folder with what one run of `mssim bench` measured: timings.csv, samples.csv, of garments garment.csv,
/// benchmark.json, provenance.json, what programs that are backends wrote, and the tables that are made of
/// the rows, as NAME.csv and NAME.md. Of `mssim guide` it holds provenance.json and tables. One at a time
/// writes into it.
class ResultFolder {
 public:
  /// Creates the folder and those above it. Throws WriteError, also where another ResultFolder, in any
  /// process, has it.
  ResultFolder(std::filesystem::path folder, Provenance provenance, TableMaker tables);

  /// Whether an earlier run left rows here.
  bool has_rows() const;
  /// Whether it left rows or tables.
  bool has_results() const;
  /// The first write replaces all that an earlier run left, its provenance too. Until then that stays.
  void replace_results() { replaces_ = true; }
  /// Takes the start of the run whose rows stay into this one's provenance.
  void go_on_with(const Provenance& earlier);
  /// Writes provenance.json, or only tries to where that of an earlier run stays for now, so that a folder
  /// that cannot be written is found before anything is measured. Throws WriteError.
  void begin() const;

  /// Writes all that follows from the rows, each file whole or not at all, timings.csv last: what stands
  /// there has its samples. To be called after every round. Throws WriteError, and std::invalid_argument for
  /// a number that is not finite, then before any file is touched.
  void write(std::span<const ResultRow> rows);

  /// Writes github.json (github_table()). Throws WriteError.
  void write_for_github(std::span<const ResultRow> rows) const;

  /// Writes tables that are not made of rows, NAME.csv and, where it has a page, NAME.md. Throws WriteError.
  void write(std::span<const ResultTable> tables);

  /// Writes table2.csv and table2.md. Throws WriteError.
  void write(std::span<const StructureRow> rows);

  struct File {
    std::string name, text;
  };

 private:
  /// Everything is on the disk under temporary names before a file is replaced, but for what `programs`
  /// wrote.
  void write_files(std::vector<File> files, const std::vector<File>& programs = {});
  void clear() const;

  std::filesystem::path folder_;
  FolderLock lock_;
  Provenance provenance_;
  TableMaker tables_;
  bool replaces_ = false;
};

/// The rows, with their samples and dressings, that an earlier run left in a folder; none when it has no
/// timings.csv. Throws CsvError.
std::vector<ResultRow> read_results(const std::filesystem::path& folder);

}  // namespace mssim
