#include "report/guide_folder.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "output/tables/table.h"
#include "platform/files.h"
#include "report/readable_records.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// Beyond this a page is none that mssim wrote.
constexpr std::size_t largest_page_bytes = std::size_t{4} << 20;

/// The columns that charts need, by their places in the files' heads.
constexpr std::array<std::string_view, 20> point_columns{
    "scene",           "nodes",        "springs_unique", "integrator",
    "backend",         "dt_s",         "steps",          "horizon_s",
    "position_error",  "energy_error", "solver_error",   "step_error",
    "reference_error", "ms_per_step",  "wall_s_per_s",   "force_evaluations_per_s",
    "samples",         "diverged",     "on_front",       "status"};
constexpr std::array<std::string_view, 6> time_columns{"scene", "integrator", "backend",
                                                       "dt_s",  "nodes",      "ms_per_step"};

template <std::size_t count>
consteval std::size_t place_of(const std::array<std::string_view, count>& columns, std::string_view name) {
  std::size_t place = 0;
  while (columns[place] != name) ++place;  // beyond the end it is no constant
  return place;
}

consteval std::size_t of_point(std::string_view name) { return place_of(point_columns, name); }
consteval std::size_t of_time(std::string_view name) { return place_of(time_columns, name); }

std::vector<GuidePoint> points_in(const CsvTable& table) {
  table.require_columns({point_columns.begin(), point_columns.end()});
  std::vector<GuidePoint> points;
  for (std::size_t record = 0; record < table.size(); ++record) {
    GuidePoint point;
    point.scene = table.text(record, of_point("scene"));
    point.integrator = table.text(record, of_point("integrator"));
    point.backend = table.text(record, of_point("backend"));
    point.status = table.text(record, of_point("status"));
    point.dt_s = table.optional_number(record, of_point("dt_s"));
    if (point.dt_s) {
      point.position_error = table.optional_number(record, of_point("position_error"));
      point.wall_s_per_s = table.optional_number(record, of_point("wall_s_per_s"));
      point.force_evaluations_per_s = table.optional_number(record, of_point("force_evaluations_per_s"));
      point.diverged = table.truth(record, of_point("diverged"));
      point.on_front = table.truth(record, of_point("on_front"));
    }
    points.push_back(std::move(point));
  }
  return points;
}

std::vector<GuideTime> times_in(const CsvTable& table) {
  table.require_columns({time_columns.begin(), time_columns.end()});
  std::vector<GuideTime> times;
  for (std::size_t record = 0; record < table.size(); ++record)
    times.push_back({table.text(record, of_time("scene")), table.text(record, of_time("integrator")),
                     table.text(record, of_time("backend")), table.number(record, of_time("nodes")),
                     table.number(record, of_time("ms_per_step"))});
  return times;
}

/// The text of a file; none, with a problem, where it cannot be read.
std::optional<std::string> text_of(const fs::path& file, std::size_t most_bytes, const std::string& without,
                                   std::vector<std::string>& problems) {
  try {
    return read_file(file, most_bytes);
  } catch (const ReadError& error) {
    problems.push_back(error.sentence(file, without));
    return std::nullopt;
  }
}

bool is_in(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error);
}

}  // namespace

std::vector<std::string> FoundGuide::scenes() const {
  std::vector<std::string> names;
  for (const GuidePoint& point : points)
    if (std::ranges::find(names, point.scene) == names.end()) names.push_back(point.scene);
  return names;
}

std::optional<FoundGuide> read_guide(const fs::path& folder, std::vector<std::string>& problems) {
  const fs::path points = folder / guide_name, times = folder / "guide-sizes.csv", page = folder / "guide.md";
  if (!is_in(points)) return std::nullopt;
  FoundGuide guide;
  if (const auto text = text_of(points, largest_csv_bytes, "errors and costs are not shown", problems))
    guide.points = readable_records(points, *text, points_in, problems);
  // Guides of bodies have no sizes.
  if (is_in(times))
    if (const auto text = text_of(times, largest_csv_bytes, "times by size are not shown", problems))
      guide.times = readable_records(times, *text, times_in, problems);
  if (const auto text = text_of(page, largest_page_bytes, "what the guide recommends is not shown", problems))
    guide.page = document_in(*text);
  return guide;
}

}  // namespace mssim
