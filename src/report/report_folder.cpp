#include "report/report_folder.h"

#include <algorithm>
#include <exception>
#include <string_view>
#include <system_error>

#include "garment/output/garment_csv.h"
#include "output/folders/provenance_file.h"
#include "output/folders/result_folder.h"
#include "output/tables/table.h"
#include "output/tables/timings_csv.h"
#include "platform/files.h"
#include "report/readable_records.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

bool has_results(const fs::path& folder) {
  return is_there(folder / timings_name) || is_there(folder / guide_name);
}

/// What lies in a folder, by name; nothing where it cannot be listed.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    entries.push_back(entry->path());
  std::ranges::sort(entries);
  return entries;
}

void read_rows(const fs::path& file, ReportFolder& folder) {
  std::string text;
  try {
    text = read_file(file, largest_csv_bytes);
  } catch (const ReadError& error) {
    folder.problems.push_back(error.sentence(file, "without it there is nothing to show"));
    return;
  }
  folder.rows = readable_records<ResultRow>(file, text, read_timings, folder.problems);
}

/// Reads what belongs to the rows from a file beside timings.csv; false where that cannot be read.
template <class Read>
bool read_beside(const fs::path& file, ReportFolder& folder, const std::string& without, Read read) {
  std::vector<ResultRow> rows = folder.rows;
  try {
    read(file, rows);
    folder.rows = std::move(rows);
    return true;
  } catch (const CsvError& error) {
    folder.problems.push_back(std::string(error.what()) + "; " + without);
    return false;
  }
}

/// Rows of a samples.csv that ended early have fewer samples than rounds, or none.
void drop_incomplete_samples(const fs::path& file, ReportFolder& folder) {
  std::size_t without = 0;
  for (ResultRow& row : folder.rows) {
    if (!counts(row) || row.samples_ms.size() == static_cast<std::size_t>(row.rounds)) continue;
    row.samples_ms.clear();
    ++without;
  }
  if (without > 0)
    folder.problems.push_back(file.string() + " has no samples of " + pluralize(without, "row"));
}

/// A time that no clock gives would only spoil what is computed of it.
void drop_impossible_times(ReportFolder& folder) {
  for (ResultRow& row : folder.rows) {
    if (!counts(row)) continue;
    const auto bad = [](double ms) { return !(ms > 0); };
    if (row.ms_per_step && bad(*row.ms_per_step)) row.ms_per_step.reset();
    if (row.ms_per_step_low && bad(*row.ms_per_step_low)) row.ms_per_step_low.reset();
    if (row.ms_per_step_high && bad(*row.ms_per_step_high)) row.ms_per_step_high.reset();
    if (row.speedup_vs_serial && bad(*row.speedup_vs_serial)) row.speedup_vs_serial.reset();
    if (std::ranges::any_of(row.samples_ms, bad)) row.samples_ms.clear();
    if (!row.ms_per_step) row.status = "failed: timings.csv has no time of it";
  }
}

void read_pictures_and_curves(const fs::path& path, ReportFolder& folder) {
  for (const fs::path& file : entries_of(path)) {
    const std::string extension = file.extension().string();
    if (extension != ".png" && extension != ".csv") continue;
    try {
      const std::string text =
          read_file(file, extension == ".png" ? largest_picture_bytes : largest_csv_bytes);
      if (extension == ".csv") {
        if (auto curve = energy_curve_in(file.stem().string(), text))
          folder.curves.push_back(std::move(*curve));
      } else if (text.starts_with("\x89PNG\r\n\x1a\n")) {
        folder.pictures.push_back({file.filename().string(), text});
      } else {
        folder.problems.push_back(file.string() + " is no PNG picture");
      }
    } catch (const ReadError& error) {
      folder.problems.push_back(error.sentence(file, "it is not shown"));
    }
  }
}

}  // namespace

std::vector<fs::path> result_folders(const fs::path& folder) {
  if (has_results(folder)) return {folder};
  std::vector<fs::path> folders = entries_of(folder);
  std::erase_if(folders, [](const fs::path& entry) { return !has_results(entry); });
  return folders;
}

ReportFolder read_report_folder(const fs::path& path) {
  ReportFolder folder;
  folder.name = path.string();
  folder.guide = read_guide(path, folder.problems);
  if (!folder.guide || is_there(path / timings_name)) read_rows(path / timings_name, folder);
  if (!folder.rows.empty()) {
    if (read_beside(path / samples_name, folder, "intervals of ratios are those of the times",
                    [](const fs::path& file, std::span<ResultRow> rows) { read_samples(file, rows); }))
      drop_incomplete_samples(path / samples_name, folder);
    if (is_there(path / garment_name))
      read_beside(path / garment_name, folder, "how garments were dressed is not shown",
                  [](const fs::path& file, std::span<ResultRow> rows) { read_dressings(file, rows); });
  }
  drop_impossible_times(folder);
  try {
    folder.provenance = read_provenance(path / "provenance.json");
  } catch (const ProvenanceError& error) {
    folder.problems.push_back(std::string(error.what()) + "; machine and settings are not known");
  }
  read_pictures_and_curves(path, folder);
  return folder;
}

std::optional<FoundCurve> energy_curve_in(const std::string& name, std::string_view text) {
  text = without_byte_order_mark(text);
  while (text.starts_with('#')) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  if (!text.starts_with("time_s,kinetic_j,")) return std::nullopt;
  FoundCurve curve{name, {}, {}};
  try {
    const CsvTable table(name, text);
    const auto total = std::ranges::find(table.header(), "total_j");
    if (total == table.header().end()) return std::nullopt;
    const auto column = static_cast<std::size_t>(total - table.header().begin());
    for (std::size_t record = 0; record < table.size(); ++record) {
      curve.time_s.push_back(table.number(record, 0));
      curve.total_j.push_back(table.number(record, column));
    }
  } catch (const CsvError&) {
    return std::nullopt;
  }
  return curve;
}

}  // namespace mssim
