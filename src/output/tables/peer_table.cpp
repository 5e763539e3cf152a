#include "output/tables/peer_table.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "output/tables/ratio_mark.h"
#include "statistics/statistics.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::string_view yardstick = "openmp";

constexpr std::string_view how_to_read_peers =
    "The same scene, integrator and time step in other languages and libraries, each written as its own "
    "documentation would have it, and each run by mssim as a program of its own: verified against the same "
    "double-precision reference, timed in the same rounds. Times are medians; *times `openmp`* is how many "
    "times as long as `openmp` a backend takes, the median of the ratios of each round with its 95 % "
    "interval. *Threads* is how many a backend says it takes, *processors* how many its steps really kept "
    "busy. *Error* is the largest distance to the reference in mean rest lengths.";

/// Its time over that of `openmp`, round by round; none where either does not count, or where the two were
/// not measured in the same rounds.
std::optional<MedianInterval> times_yardstick(RowPointers rows, const ResultRow& row) {
  const ResultRow* best = find_row(rows, row.scene, yardstick, row.integrator);
  if (!best || !counts(*best) || !counts(row) || row.samples_ms.empty() ||
      row.samples_ms.size() != best->samples_ms.size())
    return std::nullopt;
  return median_ratio(row.samples_ms, best->samples_ms);
}

Table data_of(RowPointers rows) {
  Table table;
  for (const ResultRow* row : rows) {
    const std::optional<MedianInterval> ratio = times_yardstick(rows, *row);
    const auto part = [&](double MedianInterval::*member) { return ratio ? Cell((*ratio).*member) : Cell(); };
    table.add({{"scene", row->scene},
               {"nodes", row->nodes},
               {"integrator", row->integrator},
               {"peer", row->backend},
               {"threads", row->threads},
               {"processors_used", row->processors_used},
               {"ms_per_step", row->ms_per_step},
               {"ms_per_step_low", row->ms_per_step_low},
               {"ms_per_step_high", row->ms_per_step_high},
               {"times_openmp", part(&MedianInterval::median)},
               {"times_openmp_low", part(&MedianInterval::low)},
               {"times_openmp_high", part(&MedianInterval::high)},
               {"position_error", row->position_error},
               {"verified", row->verified},
               {"status", status_of(*row)},
               {"note", row->note}});
  }
  return table;
}

const std::vector<Column> columns{{"peer"},
                                  {"threads", Align::right},
                                  {"processors", Align::right},
                                  {"ms per step", Align::right},
                                  {"times `openmp`", Align::right, "×"},
                                  {"interval", Align::right},
                                  {"error", Align::right}};

std::vector<Cell> cells_of(RowPointers rows, const ResultRow& row, const Provenance& provenance) {
  const std::optional<double> ms = counts(row) ? row.ms_per_step : std::nullopt;
  Cell threads, processors, ratio, interval, error;
  if (ms) {
    threads = row.threads;
    threads.suffix = mark_of_excess(row, provenance);
    if (row.processors_used) processors = fixed_decimal(*row.processors_used, 2);
    if (row.position_error) error = *row.position_error;
  }
  if (const auto times = times_yardstick(rows, row)) {
    ratio = times->median;
    const ResultRow* best = find_row(rows, row.scene, yardstick, row.integrator);
    ratio.suffix = mark_of_ratio(times->median, *ms, *best->ms_per_step);
    interval = three_digits(times->low) + " to " + three_digits(times->high);
  }
  return {backend_label(rows, row.backend, provenance),
          threads,
          processors,
          measured_cell(&row, ms),
          ratio,
          interval,
          error};
}

/// What the backends say of themselves, each thing once.
BulletList notes_of(RowPointers rows) {
  BulletList notes;
  for (const ResultRow* row : rows) {
    if (row->note.empty()) continue;
    const std::string item = "`" + row->backend + "`: " + row->note;
    if (std::ranges::find(notes.items, item) == notes.items.end()) notes.items.push_back(item);
  }
  return notes;
}

Document page_of(RowPointers rows, const Provenance& provenance) {
  Document page{Heading{1, "Peers, side by side"}, measured_on(rows, provenance),
                Paragraph{std::string(how_to_read_peers)}};
  const ResultRow* block = nullptr;
  for (const ResultRow* row : rows) {
    if (!block || block->scene != row->scene || block->integrator != row->integrator)
      page.insert(page.end(), {Heading{2, row->scene + ", " + row->integrator + ": " + grouped(row->nodes) +
                                              " nodes, " + grouped(row->springs_unique) + " springs"},
                               Table{columns, {}}});
    block = row;
    std::get<Table>(page.back()).rows.push_back(cells_of(rows, *row, provenance));
  }
  add_sentence(page, legend_of_ratios(page));
  add_sentence(page, legend_of_excess(rows, provenance));
  if (BulletList notes = notes_of(rows); !notes.items.empty())
    page.insert(page.end(), {Heading{2, "What they say of themselves"}, std::move(notes)});
  add_rows_without_a_time(page, rows);
  return page;
}

}  // namespace

TableMaker peer_tables() {
  return [](std::span<const ResultRow> rows, const Provenance& provenance) {
    std::vector<ResultTable> tables;
    const std::vector<const ResultRow*> pointers = pointers_to(rows);
    if (!rows.empty()) tables.push_back({"peers", data_of(pointers), page_of(pointers, provenance)});
    return tables;
  };
}

}  // namespace mssim
