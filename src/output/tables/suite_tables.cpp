#include "output/tables/suite_tables.h"

#include <algorithm>

namespace mssim {
namespace {

/// Adds the lines, one for each row, as a table with a heading for each run of rows of one scene and
/// integrator.
void add_blocks(Document& page, RowPointers rows, const Table& lines) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ResultRow& row = *rows[i];
    if (i == 0 || rows[i - 1]->scene != row.scene || rows[i - 1]->integrator != row.integrator)
      page.insert(page.end(), {Heading{2, row.scene + ", " + row.integrator + ": " + grouped(row.nodes) +
                                              " nodes, " + grouped(row.springs_unique) + " springs"},
                               Table{lines.columns, {}}});
    std::get<Table>(page.back()).rows.push_back(lines.rows[i]);
  }
}

constexpr std::string_view how_to_read_races =
    "Springs that threads process at the same time add to the forces of nodes that they share: the data race "
    "of Figure 1 of Hong et al. (2016). Each line is a method to avoid it. All but `gather-vectors` and "
    "`openmp`, which have vectors and layouts of their own, step the list of springs that `serial` steps, "
    "with the same layout, force and update, and only differ in the accumulation. Times are medians with "
    "their 95 % interval; *ratio* is how many times as fast as `serial` a method is, the median of paired "
    "samples. *Same bits*: whether a repeated run gives bitwise identical numbers.";

/// The legend of the row's method, which must exist.
const RaceLegend& legend_of(const ResultRow& row, const std::vector<RaceLegend>& legend) {
  return *std::ranges::find(legend, row.backend, &RaceLegend::method);
}

Table data_of(RowPointers rows, const std::vector<RaceLegend>& legend) {
  Table table;
  for (const ResultRow* row : rows) {
    const RaceLegend& method = legend_of(*row, legend);
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
               {"extra_memory", method.extra_memory},
               {"springs_computed", method.springs_computed},
               {"same_bits", method.repeatable},
               {"status", status_of(*row)}});
  }
  return table;
}

Document page_of(RowPointers rows, const std::vector<RaceLegend>& legend, const Provenance& provenance) {
  Table lines{{{"method"},
               {"ms per step", Align::right},
               {"interval", Align::right},
               {"ratio", Align::right, "×"},
               {"extra memory", Align::left},
               {"springs computed", Align::left},
               {"same bits", Align::left}},
              {}};
  for (const ResultRow* row : rows) {
    const RaceLegend& method = legend_of(*row, legend);
    Cell ratio;
    if (counted_ms(*row) && row->speedup_vs_serial) {
      ratio = *row->speedup_vs_serial;
      ratio.suffix = mark_of_speedup(rows, *row);
    }
    lines.rows.push_back({backend_label(rows, row->backend, provenance), measured_cell(row, counted_ms(*row)),
                          interval_cell(*row), ratio, method.extra_memory, method.springs_computed,
                          method.repeatable});
  }
  Document page{Heading{1, "Methods to avoid the data race of the springs"}, measured_on(rows, provenance),
                Paragraph{std::string(how_to_read_races)}};
  add_blocks(page, rows, lines);
  BulletList descriptions;
  for (const RaceLegend& method : legend)
    if (std::ranges::find(rows, method.method, &ResultRow::backend) != rows.end())
      descriptions.items.push_back("`" + method.method + "`: " + method.description);
  add_sentence(page, legend_of_ratios(page));
  page.insert(page.end(), {Heading{2, "The methods"}, std::move(descriptions)});
  add_sentence(page, reason_without_speedups(rows));
  add_rows_without_a_time(page, rows);
  return page;
}

/// Cost per node relative to that of the same backend on `base`.
std::optional<double> growth(RowPointers rows, const ResultRow& row, const std::string& base) {
  const ResultRow* small = find_row(rows, base, row.backend, row.integrator);
  if (!small) return std::nullopt;
  const auto here = ns_per_node(row, row.ms_per_step), there = ns_per_node(*small, small->ms_per_step);
  return here && there ? std::optional(*here / *there) : std::nullopt;
}

Table data_of(RowPointers rows, const std::string& base) {
  const std::string ratio_to_base = "ratio_to_" + base;
  Table table;
  for (const ResultRow* row : rows)
    table.add({{"integrator", row->integrator},
               {"backend", row->backend},
               {"scene", row->scene},
               {"nodes", row->nodes},
               {"ms_per_step", row->ms_per_step},
               {"ns_per_node", ns_per_node(*row, row->ms_per_step)},
               {"ns_per_node_low", ns_per_node(*row, row->ms_per_step_low)},
               {"ns_per_node_high", ns_per_node(*row, row->ms_per_step_high)},
               {ratio_to_base, growth(rows, *row, base)},
               {"status", status_of(*row)}});
  return table;
}

/// The ratio is that of the two times shown, so that they always agree.
Cell cost_cell(RowPointers rows, const ResultRow* row, const std::string& base,
               const Provenance& provenance) {
  const auto ns = row ? ns_per_node(*row, row->ms_per_step) : std::nullopt;
  Cell cell = measured_cell(row, ns);
  if (!ns) return cell;
  cell.suffix = mark_of_excess(*row, provenance);
  if (const auto ratio = growth(rows, *row, base)) cell.suffix += in_brackets(*ratio);
  return cell;
}

Document page_of(RowPointers rows, const std::string& base, const Provenance& provenance) {
  Document page{
      Heading{1, "Scaling: cost per node of increasingly large cloths"}, measured_on(rows, provenance),
      Paragraph{"Nanoseconds per node and step, medians; in brackets relative to the same backend on `" +
                base + "`. If a line stays at 1, the cost is proportional to the number of nodes."}};
  const auto scenes = distinct<std::string>(rows, &ResultRow::scene);
  std::vector<Column> columns{{"backend"}};
  for (const std::string& scene : scenes)
    columns.push_back(scene_column(**std::ranges::find(rows, scene, &ResultRow::scene)));
  for (const std::string& integrator : distinct<std::string>(rows, &ResultRow::integrator)) {
    Table table{columns, {}};
    for (const std::string& backend : distinct<std::string>(rows, &ResultRow::backend)) {
      std::vector<Cell>& cells = table.rows.emplace_back();
      cells.emplace_back(backend_label(rows, backend, provenance));
      for (const std::string& scene : scenes)
        cells.push_back(cost_cell(rows, find_row(rows, scene, backend, integrator), base, provenance));
    }
    page.insert(page.end(), {Heading{2, integrator}, std::move(table)});
  }
  add_sentence(page, legend_of_excess(rows, provenance));
  add_rows_without_a_time(page, rows);
  return page;
}

constexpr std::string_view yardstick = "openmp";

constexpr std::string_view how_to_read_peers =
    "The same scene, integrator and time step in other languages and libraries, each written as its "
    "documentation recommends, and run by mssim as a separate program. All are verified against the same "
    "double-precision reference and timed in the same rounds. Times are medians; *times `openmp`* is how "
    "many times as long as `openmp` a backend takes, the median of the ratios of each round with its 95 % "
    "interval. *Threads*: the number that a backend reports; *processors*: the number of CPUs that its steps "
    "kept busy. *Error* is the largest distance to the reference in mean rest lengths.";

/// Time over that of `openmp`, round by round; none if either does not count or they were not measured in the
/// same rounds.
std::optional<RatioInterval> times_yardstick(RowPointers rows, const ResultRow& row) {
  const ResultRow* best = find_row(rows, row.scene, yardstick, row.integrator);
  if (!best || !counts(*best) || !counts(row) || row.samples_ms.empty() ||
      row.samples_ms.size() != best->samples_ms.size())
    return std::nullopt;
  return times_as_fast(best, &row);
}

/// The cell of a part of such a ratio; of an end of its interval, only if it has one.
Cell part_of(const std::optional<RatioInterval>& ratio, double RatioInterval::*part) {
  const bool has_part = ratio && (part == &RatioInterval::ratio || ratio->covers);
  return has_part ? Cell((*ratio).*part) : Cell();
}

Table data_of(RowPointers rows) {
  Table table;
  for (const ResultRow* row : rows) {
    const std::optional<RatioInterval> times = times_yardstick(rows, *row);
    table.add({{"scene", row->scene},
               {"nodes", row->nodes},
               {"integrator", row->integrator},
               {"peer", row->backend},
               {"threads", row->threads},
               {"processors_used", row->processors_used},
               {"ms_per_step", row->ms_per_step},
               {"ms_per_step_low", row->ms_per_step_low},
               {"ms_per_step_high", row->ms_per_step_high},
               {"times_openmp", part_of(times, &RatioInterval::ratio)},
               {"times_openmp_low", part_of(times, &RatioInterval::low)},
               {"times_openmp_high", part_of(times, &RatioInterval::high)},
               {"position_error", row->position_error},
               {"verified", row->verified},
               {"status", status_of(*row)},
               {"note", row->note}});
  }
  return table;
}

/// Number of processors that the steps kept busy.
Cell busy_processors(const ResultRow& row) {
  return counted_ms(row) && row.processors_used ? Cell(fmt::format("{:.2f}", *row.processors_used)) : Cell();
}

/// The cells of rows that do not count have no numbers.
Table lines_of_peers(RowPointers rows, const Provenance& provenance) {
  Table lines{{{"peer"},
               {"threads", Align::right},
               {"processors", Align::right},
               {"ms per step", Align::right},
               {"times `openmp`", Align::right, "×"},
               {"interval", Align::right},
               {"error", Align::right}},
              {}};
  for (const ResultRow* row : rows) {
    const std::optional<double> ms = counted_ms(*row);
    const std::optional<RatioInterval> times = times_yardstick(rows, *row);
    Cell threads, error;
    if (ms) {
      threads = row->threads;
      threads.suffix = mark_of_excess(*row, provenance);
      error = row->position_error;
    }
    lines.rows.push_back({backend_label(rows, row->backend, provenance), threads, busy_processors(*row),
                          measured_cell(row, ms),
                          ratio_cell(times, row, find_row(rows, row->scene, yardstick, row->integrator)),
                          ratio_interval_cell(times), error});
  }
  return lines;
}

/// Notes of the backends, each once.
BulletList notes_of(RowPointers rows) {
  BulletList notes;
  for (const ResultRow* row : rows)
    if (!row->note.empty()) add_once(notes.items, "`" + row->backend + "`: " + row->note);
  return notes;
}

Document page_of(RowPointers rows, const Provenance& provenance) {
  Document page{Heading{1, "Peers, side by side"}, measured_on(rows, provenance),
                Paragraph{std::string(how_to_read_peers)}};
  add_blocks(page, rows, lines_of_peers(rows, provenance));
  add_sentence(page, legend_of_ratios(page));
  add_sentence(page, legend_of_excess(rows, provenance));
  if (BulletList notes = notes_of(rows); !notes.items.empty())
    page.insert(page.end(), {Heading{2, "Notes of the backends"}, std::move(notes)});
  add_rows_without_a_time(page, rows);
  return page;
}

constexpr std::string_view how_to_read_threads =
    "The same steps on different numbers of threads. *Threads*: those that computed the steps, which may be "
    "fewer than requested; of rows with the same number only the first is shown. Times are medians. "
    "*Times as fast*: as the same backend on the fewest threads, the median of the ratios of each round with "
    "its 95 % interval. *Efficiency*: that divided by the ratio of the numbers of threads. *Processors*: the "
    "number of CPUs that the steps kept busy.";

ResultTable table_of_threads(const std::vector<ThreadRow>& rows, const Provenance& provenance) {
  Table data, lines{{{"backend"},
                     {"threads", Align::right},
                     {"ms per step", Align::right},
                     {"times as fast", Align::right, "×"},
                     {"interval", Align::right},
                     {"efficiency", Align::right},
                     {"processors", Align::right}},
                    {}};
  for (const ThreadRow& its : rows) {
    const ResultRow& row = *its.row;
    const std::optional<RatioInterval> times = its.speedup();
    const Cell efficiency = times ? Cell(times->ratio * its.fewest_threads / its.threads) : Cell();
    data.add({{"scene", row.scene},
              {"nodes", row.nodes},
              {"integrator", row.integrator},
              {"backend", its.backend},
              {"threads", its.threads},
              {"processors_used", row.processors_used},
              {"ms_per_step", row.ms_per_step},
              {"ms_per_step_low", row.ms_per_step_low},
              {"ms_per_step_high", row.ms_per_step_high},
              {"speedup", part_of(times, &RatioInterval::ratio)},
              {"speedup_low", part_of(times, &RatioInterval::low)},
              {"speedup_high", part_of(times, &RatioInterval::high)},
              {"efficiency", efficiency},
              {"status", status_of(row)}});
    Cell ms = measured_cell(&row, counted_ms(row));
    if (counted_ms(row)) ms.suffix = mark_of_excess(row, provenance);
    lines.rows.push_back({fmt::format("`{}`", its.backend), its.threads, ms,
                          ratio_cell(times, its.fewest, &row), ratio_interval_cell(times), efficiency,
                          busy_processors(row)});
  }
  const auto all = mapped<const ResultRow*>(rows, &ThreadRow::row);
  Document page{Heading{1, "Scaling with threads"}, measured_on(all, provenance),
                Paragraph{std::string(how_to_read_threads)}};
  add_blocks(page, all, lines);
  add_sentence(page, legend_of_ratios(page));
  add_sentence(page, legend_of_excess(all, provenance));
  add_rows_without_a_time(page, all);
  return {"threads", std::move(data), std::move(page)};
}

}  // namespace

std::vector<ThreadRow> thread_rows(RowPointers rows, const Provenance& provenance) {
  std::vector<ThreadRow> lines, compared;
  const auto same_but_threads = [](const ThreadRow& a, const ThreadRow& b) {
    return a.backend == b.backend && a.row->scene == b.row->scene && a.row->integrator == b.row->integrator;
  };
  for (const ResultRow* row : rows) {
    const auto [backend, asked] = asked_processors(provenance, row->backend);
    if (asked > provenance.threads) continue;
    const bool has_fewer = counts(*row) && row->threads > 0 && row->threads < asked;
    const int threads = has_fewer ? row->threads : asked;
    const ThreadRow found{row, backend, threads, row, threads};
    if (std::ranges::none_of(lines, [&](const ThreadRow& line) {
          return same_but_threads(line, found) && line.threads == threads &&
                 counts(*line.row) == counts(*row);
        }))
      lines.push_back(found);
  }
  for (ThreadRow found : lines) {
    bool alone = true;
    for (const ThreadRow& other : lines) {
      if (!same_but_threads(found, other) || other.threads == found.threads) continue;
      alone = false;
      if (other.threads < found.fewest_threads) {
        found.fewest = other.row;
        found.fewest_threads = other.threads;
      }
    }
    if (!alone) compared.push_back(found);
  }
  return compared;
}

TableMaker with_thread_table(TableMaker maker) {
  return [maker = std::move(maker)](std::span<const ResultRow> rows, const Provenance& provenance) {
    std::vector<ResultTable> tables = maker(rows, provenance);
    const std::vector<const ResultRow*> pointers = pointers_to(rows);
    if (const std::vector<ThreadRow> compared = thread_rows(pointers, provenance); !compared.empty())
      tables.push_back(table_of_threads(compared, provenance));
    return tables;
  };
}

TableMaker race_tables(std::vector<RaceLegend> legend) {
  return [legend = std::move(legend)](std::span<const ResultRow> all, const Provenance& provenance) {
    std::vector<const ResultRow*> rows;
    for (const ResultRow& row : all)
      if (std::ranges::find(legend, row.backend, &RaceLegend::method) != legend.end()) rows.push_back(&row);
    if (rows.empty()) return std::vector<ResultTable>();
    return std::vector<ResultTable>{{"races", data_of(rows, legend), page_of(rows, legend, provenance)}};
  };
}

TableMaker scaling_tables(std::string base) {
  return [base = std::move(base)](std::span<const ResultRow> rows, const Provenance& provenance) {
    if (rows.empty()) return std::vector<ResultTable>();
    const std::vector<const ResultRow*> all = pointers_to(rows);
    return std::vector<ResultTable>{{"scaling", data_of(all, base), page_of(all, base, provenance)}};
  };
}

TableMaker peer_tables() {
  return [](std::span<const ResultRow> rows, const Provenance& provenance) {
    if (rows.empty()) return std::vector<ResultTable>();
    const std::vector<const ResultRow*> all = pointers_to(rows);
    return std::vector<ResultTable>{{"peers", data_of(all), page_of(all, provenance)}};
  };
}

}  // namespace mssim
