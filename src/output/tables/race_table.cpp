#include "output/tables/race_table.h"

#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>

#include "output/tables/csv.h"
#include "output/tables/markdown.h"

namespace mssim {
namespace {

constexpr std::string_view how_to_read =
    "Springs that threads process at the same time add to the forces of nodes that they share: the data race "
    "of "
    "Figure 1 of Hong et al. (2016). Each line is a way to avoid it. All but `serial` and `openmp` step the "
    "same "
    "list of springs with the same layout, force and update, and differ in the accumulation alone. Times are "
    "medians with their 95 % interval; *ratio* is how many times as fast as `serial` a way is, the median of "
    "paired samples. *Same bits* says whether a run repeated gives the very same numbers.\n";

struct Line {
  const ResultRow* row;
  const RaceLegend* legend;
};

std::vector<Line> lines_of(std::span<const ResultRow> rows, const std::vector<RaceLegend>& legend) {
  std::vector<Line> lines;
  for (const ResultRow& row : rows) {
    const auto found = std::ranges::find(legend, row.backend, &RaceLegend::way);
    if (found != legend.end()) lines.push_back({&row, &*found});
  }
  return lines;
}

std::string as_csv(const std::vector<Line>& lines) {
  std::string csv = csv_line({"scene", "nodes", "springs_unique", "integrator", "way", "threads",
                              "ms_per_step", "ms_per_step_low", "ms_per_step_high", "speedup_vs_serial",
                              "extra_memory", "springs_computed", "same_bits", "status"});
  for (const auto& [row, legend] : lines)
    csv += csv_line({row->scene, std::to_string(row->nodes), std::to_string(row->springs_unique),
                     row->integrator, row->backend, std::to_string(row->threads),
                     csv_number(row->ms_per_step), csv_number(row->ms_per_step_low),
                     csv_number(row->ms_per_step_high), csv_number(row->speedup_vs_serial),
                     legend->extra_memory, legend->springs_computed, legend->repeatable, status_of(*row)});
  return csv;
}

/// Time, interval and ratio, or why there are none.
std::string timing_cells(const ResultRow& row) {
  if (!counts(row) || !row.ms_per_step) {
    const std::string status = status_of(row);
    return one_cell(status.substr(0, status.find(':'))) + " | – | –";
  }
  std::string cells = "**" + three_digits(*row.ms_per_step) + "** | ";
  cells += row.ms_per_step_low && row.ms_per_step_high
               ? three_digits(*row.ms_per_step_low) + " to " + three_digits(*row.ms_per_step_high)
               : "–";
  return cells + " | " + (row.speedup_vs_serial ? three_digits(*row.speedup_vs_serial) + "×" : "–");
}

std::string as_markdown(const std::vector<Line>& lines, const std::vector<RaceLegend>& ways,
                        const Provenance& provenance) {
  std::vector<const ResultRow*> rows;
  for (const Line& line : lines) rows.push_back(line.row);
  std::ostringstream text;
  text << "# Ways to avoid the data race of the springs\n\n" << measured_on(rows, provenance) << how_to_read;
  const ResultRow* block = nullptr;
  for (const auto& [row, legend] : lines) {
    if (!block || block->scene != row->scene || block->integrator != row->integrator)
      text << "\n## " << row->scene << ", " << row->integrator << ": " << grouped(row->nodes) << " nodes, "
           << grouped(row->springs_unique) << " springs\n\n"
           << "| way | ms per step | interval | ratio | extra memory | springs computed | same bits |\n"
              "|---|---:|---:|---:|---|---|---|\n";
    block = row;
    text << "| `" << row->backend << "` | " << timing_cells(*row) << " | " << legend->extra_memory << " | "
         << legend->springs_computed << " | " << legend->repeatable << " |\n";
  }
  text << "\n## The ways\n\n";
  for (const RaceLegend& way : ways)
    if (std::ranges::any_of(lines, [&](const Line& line) { return line.legend == &way; }))
      text << "- `" << way.way << "`: " << way.description << "\n";
  text << paragraph(reason_without_speedups(rows)) << rows_without_a_time(rows);
  return text.str();
}

}  // namespace

TableMaker race_tables(std::vector<RaceLegend> legend) {
  return [legend = std::move(legend)](std::span<const ResultRow> rows, const Provenance& provenance) {
    const std::vector<Line> lines = lines_of(rows, legend);
    std::vector<ResultTable> tables;
    if (!lines.empty()) tables.push_back({"races", as_csv(lines), as_markdown(lines, legend, provenance)});
    return tables;
  };
}

}  // namespace mssim
