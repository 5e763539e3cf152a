#include <algorithm>
#include <system_error>

#include "garment/output/garment_tables.h"
#include "output/folders/provenance_file.h"
#include "output/folders/result_folder.h"
#include "platform/files.h"
#include "report/report.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// Larger pictures are not embedded; mssim guide writes no larger page.
constexpr std::size_t largest_picture_bytes = std::size_t{8} << 20, largest_page_bytes = std::size_t{4} << 20;

/// The points of a guide; a folder that has this file is a guide's.
constexpr const char* guide_name = "guide.csv";
/// The meshes of bodies.
constexpr const char* structure_name = "table2.csv";

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

bool has_results(const fs::path& folder) {
  return is_there(folder / timings_name) || is_there(folder / guide_name) ||
         is_there(folder / structure_name);
}

/// The text of a file; none, and a problem, if it cannot be read.
std::optional<std::string> text_of(const fs::path& file, std::size_t most_bytes, const std::string& without,
                                   std::vector<std::string>& problems) {
  try {
    return read_file(file, most_bytes);
  } catch (const ReadError& error) {
    problems.push_back(error.sentence(file, without));
    return std::nullopt;
  }
}

/// The records that `read` makes of a file. If it throws CsvError, each line is read separately, and a
/// problem has the reason and the number of lines lost. A file without records is a problem, too.
template <class Record>
std::vector<Record> records_of(const fs::path& file, const std::string& without,
                               std::vector<Record> (*read)(const CsvTable&),
                               std::vector<std::string>& problems) {
  std::vector<Record> records;
  const auto text = text_of(file, largest_csv_bytes, without, problems);
  if (!text) return records;
  try {
    records = read(CsvTable(file.string(), *text));
  } catch (const CsvError& error) {
    std::string_view rest = *text;
    const std::string_view head = take_to(rest, "\n");
    std::size_t lost = 0;
    while (!rest.empty()) {
      const std::string alone = fmt::format("{}\n{}\n", head, take_to(rest, "\n"));
      try {
        for (Record& record : read(CsvTable(file.string(), alone))) records.push_back(std::move(record));
      } catch (const CsvError&) {
        ++lost;
      }
    }
    problems.push_back(
        fmt::format("{}; {} left out, {} shown", error.what(), pluralize(lost, "row"), records.size()));
  }
  if (records.empty()) problems.push_back(file.string() + " has no row that can be shown");
  return records;
}

/// Reads further data of the rows from a file next to timings.csv; false if it cannot be read.
bool read_beside(const fs::path& file, ReportFolder& folder, const std::string& without,
                 void (*read)(const CsvTable& table, std::span<ResultRow> rows)) {
  std::vector<ResultRow> rows = folder.rows;
  try {
    read(CsvTable(file), rows);
    folder.rows = std::move(rows);
    return true;
  } catch (const CsvError& error) {
    folder.problems.push_back(std::string(error.what()) + "; " + without);
    return false;
  }
}

/// Removes the samples of rows that have fewer than rounds, as in a truncated samples.csv.
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

/// Removes what is no time, which would spoil derived numbers, and the samples of rows that have one such. A
/// problem names each row.
void drop_impossible_times(const fs::path& path, ReportFolder& folder) {
  const auto tell = [&](const char* file, const ResultRow& row, const std::string& what, double value,
                        std::string_view left_out) {
    folder.problems.push_back(fmt::format("{}: {} of {} is {:.6g}, {}; {} left out", (path / file).string(),
                                          what, combination_name(row), value, not_a_time, left_out));
  };
  for (ResultRow& row : folder.rows) {
    for (const TimeColumn& column : time_columns) {
      std::optional<double>& time = row.*column.value;
      if (!time || is_time(*time)) continue;
      tell(timings_name, row, std::string(column.name), *time, "it is");
      time.reset();
    }
    if (const auto bad = std::ranges::find_if_not(row.samples_ms, is_time); bad != row.samples_ms.end()) {
      tell(samples_name, row, fmt::format("round {}", bad - row.samples_ms.begin() + 1), *bad,
           "the row's samples are");
      row.samples_ms.clear();
      row.sample_steps.clear();
    }
    if (counts(row) && !row.ms_per_step) row.status = "failed: timings.csv has no time for it";
  }
}

void read_pictures_and_curves(const fs::path& path, ReportFolder& folder) {
  for (const fs::path& file : entries_of(path)) {
    const bool is_picture = file.extension() == ".png";
    if (!is_picture && file.extension() != ".csv") continue;
    auto text = text_of(file, is_picture ? largest_picture_bytes : largest_csv_bytes, "it is not shown",
                        folder.problems);
    if (!text) continue;
    if (!is_picture) {
      try {
        if (auto curve = energy_curve_in(file.stem().string(), *text))
          folder.curves.push_back(std::move(*curve));
      } catch (const CsvError& error) {
        folder.problems.push_back(
            fmt::format("{}: {}; this curve is not shown", file.string(), error.what()));
      }
    } else if (text->starts_with("\x89PNG\r\n\x1a\n")) {
      folder.pictures.push_back({file.filename().string(), std::move(*text)});
    } else {
      folder.problems.push_back(file.string() + " is not a PNG picture");
    }
  }
}

std::vector<GuidePoint> points_in(const CsvTable& table) {
  const auto at = [&](std::string_view name) { return table.column(name); };
  std::vector<GuidePoint> points;
  for (std::size_t record = 0; record < table.size(); ++record) {
    GuidePoint& point = points.emplace_back();
    point.scene = table.text(record, at("scene"));
    point.integrator = table.text(record, at("integrator"));
    point.backend = table.text(record, at("backend"));
    point.status = table.text(record, at("status"));
    point.dt_s = table.optional_number(record, at("dt_s"));
    if (!point.dt_s) continue;
    point.position_error = table.optional_number(record, at("position_error"));
    point.wall_s_per_s = table.optional_number(record, at("wall_s_per_s"));
    point.force_evaluations_per_s = table.optional_number(record, at("force_evaluations_per_s"));
    point.diverged = table.truth(record, at("diverged"));
    point.on_front = table.truth(record, at("on_front"));
  }
  return points;
}

std::vector<GuideTime> times_in(const CsvTable& table) {
  const auto at = [&](std::string_view name) { return table.column(name); };
  std::vector<GuideTime> times;
  for (std::size_t record = 0; record < table.size(); ++record)
    times.push_back({table.text(record, at("scene")), table.text(record, at("integrator")),
                     table.text(record, at("backend")), table.number(record, at("nodes")),
                     table.number(record, at("ms_per_step"))});
  return times;
}

/// None if the folder has no guide.csv.
std::optional<FoundGuide> read_guide(const fs::path& folder, std::vector<std::string>& problems) {
  if (!is_there(folder / guide_name)) return std::nullopt;
  FoundGuide guide;
  guide.points = records_of(folder / guide_name, "errors and costs are not shown", points_in, problems);
  // Guides of bodies have no sizes.
  if (const fs::path times = folder / "guide-sizes.csv"; is_there(times))
    guide.times = records_of(times, "times by size are not shown", times_in, problems);
  if (const auto text = text_of(folder / "guide.md", largest_page_bytes,
                                "what the guide recommends is not shown", problems))
    guide.page = document_in(*text);
  return guide;
}

}  // namespace

std::vector<std::string> FoundGuide::scenes() const {
  return distinct<std::string>(points, &GuidePoint::scene);
}

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
  if (is_there(path / structure_name))
    folder.bodies =
        records_of(path / structure_name, "its bodies are not shown", read_structure, folder.problems);
  if ((!folder.guide && folder.bodies.empty()) || is_there(path / timings_name))
    folder.rows =
        records_of(path / timings_name, "without it there is nothing to show", read_timings, folder.problems);
  if (!folder.rows.empty()) {
    if (read_beside(path / samples_name, folder, "intervals of ratios follow from those of the times",
                    read_samples)) {
      keep_rounds_of_timings(folder.rows);
      drop_incomplete_samples(path / samples_name, folder);
    }
    if (is_there(path / garment_name))
      read_beside(path / garment_name, folder, "the draping of garments is not shown", read_dressings);
  }
  drop_impossible_times(path, folder);
  if (const std::string unchecked = about_unchecked_samples(folder.rows); !unchecked.empty())
    folder.problems.push_back((path / timings_name).string() + ": " + unchecked);
  try {
    folder.provenance = read_provenance(path / provenance_name);
  } catch (const LaterFormatError&) {
    throw;
  } catch (const ProvenanceError& error) {
    folder.problems.push_back(std::string(error.what()) + "; machine and settings are unknown");
  }
  read_pictures_and_curves(path, folder);
  for (const std::string_view name : table_names)
    if (is_there(path / (std::string(name) + ".md"))) folder.tables.emplace_back(name);
  return folder;
}

std::optional<FoundCurve> energy_curve_in(const std::string& name, std::string_view text) {
  text = without_byte_order_mark(text);
  while (text.starts_with('#')) take_to(text, "\n");
  if (!text.starts_with("time_s,kinetic_j,")) return std::nullopt;
  FoundCurve curve{name, {}, {}};
  const CsvTable table(name, text);
  const auto total = std::ranges::find(table.header(), "total_j");
  if (total == table.header().end()) return std::nullopt;
  const auto column = static_cast<std::size_t>(total - table.header().begin());
  for (std::size_t record = 0; record < table.size(); ++record) {
    curve.time_s.push_back(table.number(record, 0));
    curve.total_j.push_back(table.number(record, column));
  }
  return curve;
}

}  // namespace mssim
