#include "commands/bench/measured_run.h"

#include <system_error>

#include "output/folders/provenance_file.h"
#include "output/folders/result_folder.h"
#include "text/error.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    throw UsageError("there is no " + path.string() + ": give a folder that mssim bench --out wrote");
  fs::path folder = fs::is_directory(status) ? path
                    : path.has_parent_path() ? path.parent_path()
                                             : fs::path(".");
  if (!fs::exists(folder / "timings.csv", error))
    throw UsageError(folder.string() + " holds no timings.csv: give a folder that mssim bench --out wrote");
  return folder;
}

/// What numbers of a row can be computed from is shorter.
constexpr double longest_ms = 1e12;

/// What is measured has a time above zero in every round.
void require_samples(const ResultRow& row, const fs::path& folder) {
  if (row.status != "ok") return;
  const std::string where = (folder / "samples.csv").string() + ": " + combination_name(row) + " has ";
  if (row.samples_ms.empty())
    throw UsageError(where + "no samples, though timings.csv says ok; measure the folder anew");
  for (std::size_t round = 0; round < row.samples_ms.size(); ++round)
    if (!(row.samples_ms[round] > 0 && row.samples_ms[round] <= longest_ms))
      throw UsageError(where + "no time above zero in round " + std::to_string(round + 1) +
                       ", or one of more than 1e12 ms; measure the folder anew");
}

}  // namespace

MeasuredRun read_run(const fs::path& path) {
  const fs::path folder = folder_of(path);
  MeasuredRun run{read_provenance(folder / "provenance.json"), read_results(folder)};
  for (const ResultRow& row : run.rows) require_samples(row, folder);
  return run;
}

}  // namespace mssim
