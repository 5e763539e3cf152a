#include <algorithm>
#include <cmath>

#include "report/report_internal.h"
#include "text/text.h"

namespace mssim {

std::optional<double> exponent_of(std::span<const double> x, std::span<const double> y) {
  double mean_x = 0, mean_y = 0, across = 0, along = 0;
  const auto count = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / count;
    mean_y += std::log(y[i]) / count;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x;
    across += dx * (std::log(y[i]) - mean_y);
    along += dx * dx;
  }
  if (!(along > 0)) return std::nullopt;
  return across / along;
}

namespace {

std::string row_name(const ResultRow& row) {
  return fmt::format("`{}` on `{}`, {}", row.backend, row.scene, row.integrator);
}

std::string subject(std::size_t number, const std::string& noun, const std::string& one,
                    const std::string& several) {
  return pluralize(number, noun) + (number == 1 ? one : several);
}

/// "`opencl` on DEVICE" for each backend that ran on an OpenCL device.
std::string devices_of(std::span<const ResultRow> rows, const Provenance& provenance) {
  const std::vector<const ResultRow*> pointers = pointers_to(rows);
  std::vector<std::string> labels;
  for (const ResultRow& row : rows) {
    if (!opencl_device(row).empty()) add_once(labels, backend_label(pointers, row.backend, provenance));
  }
  return join(labels, "; ");
}

/// The first row for each reason and the number of others that have it; at most three reasons.
std::string by_reason(const std::vector<const ResultRow*>& rows) {
  constexpr std::size_t most = 3;
  const auto reason_of = [](const ResultRow* row) { return status_of(*row); };
  std::vector<std::string> parts;
  std::size_t others = rows.size();
  for (const std::string& reason : distinct<std::string>(rows, reason_of)) {
    if (parts.size() == most) break;
    const auto count = static_cast<std::size_t>(std::ranges::count(rows, reason, reason_of));
    parts.push_back(fmt::format("{}{} ({})", row_name(**std::ranges::find(rows, reason, reason_of)),
                                count > 1 ? fmt::format(" and {} more", count - 1) : "", reason));
    others -= count;
  }
  if (others > 0)
    parts.push_back(
        fmt::format("the list *Rows without a time* has {} with other reasons", pluralize(others, "row")));
  return join(parts, "; ");
}

Finding about_speedups(std::span<const ResultRow> rows) {
  const std::vector<const ResultRow*> pointers = pointers_to(rows);
  std::vector<std::string> near_one;
  std::string_view baseline = baseline_name;
  std::size_t all = 0, without = 0;
  for (const ResultRow& row : rows) {
    const ResultRow* serial = baseline_of(pointers, row);
    const auto ratio = serial == &row ? std::nullopt : times_as_fast(&row, serial);
    if (!ratio) continue;
    ++all;
    baseline = serial->backend;
    if (!ratio->covers)
      ++without;
    else if (ratio->side_of(1) == 0)
      near_one.push_back(
          fmt::format("{} ({} to {})", row_name(row), three_digits(ratio->low), three_digits(ratio->high)));
  }
  if (all == 0)
    return {false,
            fmt::format("There are no speed-ups: no row that counts has a row of `{}` to compare with.",
                        baseline)};
  std::string text = pluralize(all, "speed-up") + fmt::format(" over `{}`", baseline);
  if (!near_one.empty())
    text += ": " + subject(near_one.size(), "interval", " includes 1", " include 1") +
            ", so neither backend is certainly faster: " + join(near_one, "; ");
  else if (without < all)
    text += ": no interval includes 1";
  if (without > 0)
    text += ". " + subject(without, "speed-up", " has", " have") + " too few rounds for a 95 % interval";
  return {false, text + "."};
}

/// The sign only repeats the word.
std::string verified_mark(const ResultRow& row) {
  if (counts(row)) return "✓ yes";
  return is_wrong(row) ? "✗ **no**" : "– " + row.status.substr(0, row.status.find(':'));
}

}  // namespace

std::vector<Finding> row_findings(std::span<const ResultRow> rows, const Provenance& provenance) {
  std::vector<Finding> findings;
  if (rows.empty()) return findings;
  if (const std::string devices = devices_of(rows, provenance); !devices.empty())
    findings.push_back({false, fmt::format("The published GPU is that of a {}. Devices of these rows: {}.",
                                           paper_device, devices)});
  std::vector<const ResultRow*> wrong;
  std::size_t timed = 0, unchecked = 0, without_time = 0;
  for (const ResultRow& row : rows)
    if (counts(row)) {
      ++timed;
      if (has_unchecked_samples(row)) ++unchecked;
    } else if (is_wrong(row)) {
      wrong.push_back(&row);
    } else {
      ++without_time;
    }
  if (timed > 0)
    findings.push_back(
        {false, subject(timed, "row", " has a time, and is",
                        wrong.empty() ? " have a time, and all are" : " have a time, and are") +
                    " verified against the double-precision reference" +
                    (unchecked > 0 ? fmt::format(", but the samples of {} are not checked yet",
                                                 pluralize(unchecked, "row"))
                                   : "") +
                    "."});
  if (!wrong.empty())
    findings.push_back({true, subject(wrong.size(), "row", " failed or is not verified, and is",
                                      " failed or are not verified, and are") +
                                  " excluded from all statistics: " + by_reason(wrong) + "."});
  if (without_time > 0)
    findings.push_back({false, subject(without_time, "row", " has", " have") +
                                   " no time; the list *Rows without a time* says why."});
  findings.push_back(about_speedups(rows));
  return findings;
}

std::string noise_of(const ReportFolder& folder) {
  if (!folder.provenance || folder.provenance->noise.empty()) return {};
  const auto sources = mapped<std::string>(folder.provenance->noise, [](const std::string& sentence) {
    return sentence.substr(0, sentence.find(": "));
  });
  return fmt::format("{}: {}.", is_from_page(folder) ? "During the run" : "When the run started",
                     join(sources, "; "));
}

bool is_from_page(const ReportFolder& folder) {
  return std::ranges::any_of(folder.rows, is_browser_backend, &ResultRow::backend);
}

std::string range_of(const ReportFolder& folder, int ResultRow::*count) {
  int least = 0, most = 0;
  for (const ResultRow& row : folder.rows)
    if (row.*count > 0) {
      least = least == 0 ? row.*count : std::min(least, row.*count);
      most = std::max(most, row.*count);
    }
  return least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most);
}

std::string short_name(const ReportFolder& folder) {
  std::filesystem::path name = std::filesystem::path(folder.name).lexically_normal();
  if (!name.has_filename()) name = name.parent_path();  // it ended with a slash
  return (name.parent_path().filename() / name.filename()).string();
}

Table times_of(RowPointers rows, const ReportFolder& folder) {
  const std::vector<const ResultRow*> all = pointers_to(folder.rows);
  const Provenance provenance = folder.where_from();
  Table table{{{"scene"},
               {"ms per step", Align::right},
               {"backend"},
               {"integrator"},
               {"threads"},
               {"95 % interval (ms)", Align::right},
               {"speed-up", Align::right, "×"},
               {"95 % interval", Align::right},
               {"published (ms)", Align::right},
               {"of the roof (%)", Align::right},
               {"verified"}},
              {}};
  for (const ResultRow* row : rows) {
    const ResultRow* serial = baseline_of(all, *row);
    const auto speedup = serial != row ? times_as_fast(row, serial) : std::nullopt;
    const bool shown = counts(*row);
    Cell published = row->paper_ms;
    published.exact = true;
    table.rows.push_back({row->scene, shown ? Cell(row->ms_per_step) : Cell(),
                          look_on(opencl_device(*row), row->backend, provenance).name, row->integrator,
                          row->threads > 0 ? Cell(row->threads) : Cell(), interval_cell(*row),
                          ratio_cell(speedup, serial, row), ratio_interval_cell(speedup), published,
                          shown && row->roofline_fraction ? Cell(100 * *row->roofline_fraction) : Cell(),
                          verified_mark(*row)});
  }
  return table;
}

void add_notes_of_programs(Document& page, const ReportFolder& folder) {
  const Provenance provenance = folder.where_from();
  BulletList list;
  for (const ResultRow& row : folder.rows)
    if (is_of_program(provenance, row.backend) && counts(row) && !row.note.empty())
      add_once(list.items, fmt::format("`{}`: {}", row.backend, row.note));
  if (!list.items.empty()) page.insert(page.end(), {Heading{2, "Notes of the programs"}, std::move(list)});
}

}  // namespace mssim
