#include "output/tables/race_table.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "output/tables/ratio_mark.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::string_view how_to_read_races =
    "Springs that threads process at the same time add to the forces of nodes that they share: the data race "
    "of Figure 1 of Hong et al. (2016). Each line is a method to avoid it. All but "
    "`gather-vectors` and `openmp`, which have vectors and layouts of their own, step the list of springs "
    "that "
    "`serial` steps, with the same layout, force and update, and differ in the accumulation alone. Times are "
    "medians with their 95 % interval; *ratio* is how many times as fast as `serial` a "
    "method is, the median of paired samples. *Same bits* says whether a run repeated gives the very same "
    "numbers.";

const std::vector<Column> race_columns{{"method"},
                                       {"ms per step", Align::right},
                                       {"interval", Align::right},
                                       {"ratio", Align::right, "×"},
                                       {"extra memory", Align::left},
                                       {"springs computed", Align::left},
                                       {"same bits", Align::left}};

struct Line {
  const ResultRow* row;
  const RaceLegend* legend;
};

std::vector<Line> lines_of(std::span<const ResultRow> rows, const std::vector<RaceLegend>& legend) {
  std::vector<Line> lines;
  for (const ResultRow& row : rows) {
    const auto found = std::ranges::find(legend, row.backend, &RaceLegend::method);
    if (found != legend.end()) lines.push_back({&row, &*found});
  }
  return lines;
}

Table data_of(const std::vector<Line>& lines) {
  Table table;
  for (const auto& [row, legend] : lines)
    table.add({{"scene", row->scene},
               {"nodes", row->nodes},
               {"springs_unique", row->springs_unique},
               {"integrator", row->integrator},
               {"method", row->backend},
               {"threads", row->threads},
               {"ms_per_step", row->ms_per_step},
               {"ms_per_step_low", row->ms_per_step_low},
               {"ms_per_step_high", row->ms_per_step_high},
               {"speedup_vs_serial", row->speedup_vs_serial},
               {"extra_memory", legend->extra_memory},
               {"springs_computed", legend->springs_computed},
               {"same_bits", legend->repeatable},
               {"status", status_of(*row)}});
  return table;
}

/// Time, interval and ratio, or why there are none; then what the legend says.
std::vector<Cell> cells_of(const Line& line, RowPointers rows, const Provenance& provenance) {
  const auto& [row, legend] = line;
  const std::optional<double> ms = counts(*row) ? row->ms_per_step : std::nullopt;
  Cell interval, ratio;
  if (ms && row->ms_per_step_low && row->ms_per_step_high)
    interval = three_digits(*row->ms_per_step_low) + " to " + three_digits(*row->ms_per_step_high);
  if (ms && row->speedup_vs_serial) {
    ratio = row->speedup_vs_serial;
    ratio.suffix = mark_of_speedup(rows, *row);
  }
  return {backend_label(rows, row->backend, provenance),
          measured_cell(row, ms),
          interval,
          ratio,
          legend->extra_memory,
          legend->springs_computed,
          legend->repeatable};
}

Document page_of(const std::vector<Line>& lines, const std::vector<RaceLegend>& methods,
                 const Provenance& provenance) {
  std::vector<const ResultRow*> rows;
  for (const Line& line : lines) rows.push_back(line.row);
  Document page{Heading{1, "Methods to avoid the data race of the springs"}, measured_on(rows, provenance),
                Paragraph{std::string(how_to_read_races)}};
  const ResultRow* block = nullptr;
  for (const Line& line : lines) {
    const ResultRow& row = *line.row;
    if (!block || block->scene != row.scene || block->integrator != row.integrator)
      page.insert(page.end(), {Heading{2, row.scene + ", " + row.integrator + ": " + grouped(row.nodes) +
                                              " nodes, " + grouped(row.springs_unique) + " springs"},
                               Table{race_columns, {}}});
    block = &row;
    std::get<Table>(page.back()).rows.push_back(cells_of(line, rows, provenance));
  }
  BulletList descriptions;
  for (const RaceLegend& method : methods)
    if (std::ranges::find(lines, &method, &Line::legend) != lines.end())
      descriptions.items.push_back("`" + method.method + "`: " + method.description);
  add_sentence(page, legend_of_ratios(page));
  page.insert(page.end(), {Heading{2, "The methods"}, std::move(descriptions)});
  add_sentence(page, reason_without_speedups(rows));
  add_rows_without_a_time(page, rows);
  return page;
}

}  // namespace

TableMaker race_tables(std::vector<RaceLegend> legend) {
  return [legend = std::move(legend)](std::span<const ResultRow> rows, const Provenance& provenance) {
    const std::vector<Line> lines = lines_of(rows, legend);
    std::vector<ResultTable> tables;
    if (!lines.empty()) tables.push_back({"races", data_of(lines), page_of(lines, legend, provenance)});
    return tables;
  };
}

}  // namespace mssim
