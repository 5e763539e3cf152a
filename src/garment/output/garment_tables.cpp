#include "garment/output/garment_tables.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "garment/stepping/published_dressing.h"
#include "text/text.h"

namespace mssim {
namespace {

using Rows = std::vector<const ResultRow*>;

/// The rows of all scenes that any backend has dressed, in their order.
Rows rows_of_dressed_scenes(std::span<const ResultRow> rows) {
  std::set<std::string_view> scenes;
  for (const ResultRow& row : rows)
    if (row.dressing) scenes.insert(row.scene);
  Rows found;
  for (const ResultRow& row : rows)
    if (scenes.contains(row.scene)) found.push_back(&row);
  return found;
}

/// Milliseconds per iteration of a whole dressing; none without iterations.
std::optional<double> ms_per_iteration(const DressingRecord& dressing) {
  if (dressing.iterations == 0) return std::nullopt;
  return 1e3 * dressing.wall_s / static_cast<double>(dressing.iterations);
}

/// A line of a table: backend and integrator.
using Line = std::pair<std::string, std::string>;

/// The layout of the table. Its columns are scenes, by number of vertices; its lines are combinations that
/// have dressed any scene.
struct Layout {
  explicit Layout(Rows all) : rows(std::move(all)) {
    for (const ResultRow* row : rows) {
      if (std::ranges::find(scenes, row->scene, &ResultRow::scene) == scenes.end()) scenes.push_back(row);
      const Line line(row->backend, row->integrator);
      if (row->dressing) add_once(lines, line);
    }
    std::ranges::stable_sort(scenes, {}, &ResultRow::nodes);
  }

  const ResultRow* find(const ResultRow& scene, const Line& line) const {
    return find_row(rows, scene.scene, line.first, line.second);
  }

  Rows rows;
  Rows scenes;  ///< the first row of each
  std::vector<Line> lines;
};

/// Null for other backends. The backend's name may end in a colon and a number of threads.
const PublishedDressing* published_dressing(std::string_view backend) {
  return found_in(published_dressings, backend.substr(0, backend.find(':')), &PublishedDressing::name);
}

/// Start of the first cell of a line.
std::string parallelisation_of(const Line& line) {
  return std::string(published_dressing(line.first) ? "as printed, " : "") +
         (is_parallel(line.first) ? "with: " : "without: ");
}

/// A cell of the table of times.
Cell time_cell(RowPointers rows, const ResultRow& row) {
  const std::optional<double> ms = counted_ms(row);
  Cell cell = measured_cell(&row, ms);
  if (ms && row.speedup_vs_serial && row.backend != baseline_name)
    cell.suffix.append(in_brackets(*row.speedup_vs_serial)).append(mark_of_speedup(rows, row));
  return cell;
}

/// The row's dressing if it ended with a settled garment and the row is not wrong; otherwise null.
const DressingRecord* whole_dressing(const ResultRow& row) {
  return row.dressing && row.dressing->settled && !is_wrong(row) ? &*row.dressing : nullptr;
}

Cell dressing_cell(RowPointers /*rows*/, const ResultRow& row) {
  if (const DressingRecord* dressing = whole_dressing(row))
    return three_digits(dressing->wall_s) + " s\n" + grouped(dressing->iterations);
  if (!row.dressing) return {};
  return row.dressing->settled ? measured_cell(&row, std::nullopt) : Cell("not settled");
}

using MakeCell = Cell (*)(RowPointers rows, const ResultRow& row);

Table table_of(const Layout& layout, const Provenance& provenance, const std::string& title, MakeCell make) {
  Table table{{{title}}, {}};
  for (const ResultRow* scene : layout.scenes) table.columns.push_back(scene_column(*scene));
  for (const Line& line : layout.lines) {
    std::vector<Cell>& cells = table.rows.emplace_back();
    cells.emplace_back(parallelisation_of(line) + backend_label(layout.rows, line.first, provenance));
    for (const ResultRow* scene : layout.scenes) {
      const ResultRow* row = layout.find(*scene, line);
      Cell& cell = cells.emplace_back(row ? make(layout.rows, *row) : Cell());
      if (row) cell.suffix += mark_of_excess(*row, provenance);
    }
  }
  return table;
}

/// Lists rows that are timed although their garment does not fit; only published algorithms have such rows.
void add_misfits(Document& page, const Rows& rows) {
  BulletList list;
  for (const ResultRow* row : rows) {
    if (!row->dressing || !counts(*row)) continue;
    const std::vector<std::string> found = out_of_bounds(*row->dressing);
    if (!found.empty())
      list.items.push_back(fmt::format("`{}` on `{}`: {}", row->backend, row->scene, join(found, ", ")));
  }
  if (!list.items.empty())
    page.insert(page.end(), {Heading{2, "Timed, but not dressed within bounds"}, std::move(list)});
}

Document page_of(const Layout& layout, const Provenance& provenance) {
  Document page{
      Heading{1, "Figure 6 of Vassilev: milliseconds per iteration against vertices"},
      measured_on(layout.rows, provenance),
      Paragraph{
          "Median times per iteration of Algorithm 1 for garments that hang draped on the body: springs, "
          "joints, collision with the body and the correction of velocities act. Numbers in brackets are "
          "speed-ups over `serial`. The paper's measurement was of jeans, without collisions of cloth with "
          "cloth; garments of one layer have none."},
      Paragraph{
          "The paper shows four curves, without numbers: a laptop (Intel Core i7-4702MQ, four cores, eight "
          "threads, 2.2 GHz) and a mobile device (ARM Cortex-A17, four cores, 1.7 GHz), each without and "
          "with parallelisation. Lines *as printed* run its Algorithm 1 loop by loop, with and without SIMD "
          "instructions. The other lines run mssim's own form, which limits elongations and closes seams by "
          "constraints on velocities."},
      table_of(layout, provenance, "milliseconds per iteration", time_cell),
      Paragraph{"Nanoseconds per iteration and vertex, from the same samples:"},
      table_of(layout, provenance, "nanoseconds",
               [](RowPointers, const ResultRow& row) -> Cell { return ns_per_node(row, row.ms_per_step); }),
      Paragraph{"One whole dressing: seconds and iterations from flat panels to the settled garment. "
                "`garment.csv` has the fit of each."},
      table_of(layout, provenance, "dressing", dressing_cell)};
  add_sentence(page, legend_of_ratios(page));
  add_sentence(page, legend_of_excess(layout.rows, provenance));
  add_sentence(page, reason_without_speedups(layout.rows));
  add_misfits(page, layout.rows);
  add_rows_without_a_time(page, layout.rows);
  return page;
}

Table data_of(const Layout& layout) {
  Table table{{{"backend"}, {"integrator"}, {"parallel"}, {"quantity"}}, {}};
  std::vector<Cell>& vertices = table.rows.emplace_back();
  vertices = {{}, {}, {}, "vertices"};
  for (const ResultRow* scene : layout.scenes) {
    table.columns.push_back({scene->scene});
    vertices.emplace_back(scene->nodes);
  }
  for (const Line& line : layout.lines) {
    const auto add = [&](std::string_view quantity, auto&& value) {
      std::vector<Cell>& cells = table.rows.emplace_back();
      cells = {line.first, line.second, is_parallel(line.first) ? "with" : "without", quantity};
      for (const ResultRow* scene : layout.scenes) {
        const ResultRow* row = layout.find(*scene, line);
        cells.push_back(row ? Cell(value(*row)) : Cell());
      }
    };
    using Number = std::optional<double>;
    add("ms_per_iteration", counted_ms);
    add("speedup_vs_serial",
        [](const ResultRow& row) { return counts(row) ? row.speedup_vs_serial : Number(); });
    add("ns_per_iteration_and_vertex",
        [](const ResultRow& row) { return ns_per_node(row, row.ms_per_step); });
    add("dressing_s", [](const ResultRow& row) {
      const DressingRecord* dressing = whole_dressing(row);
      return dressing ? Number(dressing->wall_s) : Number();
    });
    add("dressing_iterations", [](const ResultRow& row) {
      const DressingRecord* dressing = whole_dressing(row);
      return dressing ? Cell(dressing->iterations) : Cell();
    });
  }
  return table;
}

template <auto member>
Cell of_row(const ResultRow& row) {
  return row.*member;
}

/// Nothing without a dressing.
template <auto member>
Cell of_dressing(const ResultRow& row) {
  return row.dressing ? Cell(*row.dressing.*member) : Cell();
}

/// A column of garment.csv that every row has.
struct GarmentColumn {
  std::string_view name;
  Cell (*cell)(const ResultRow& row);
};

/// The TABLE of columns, in order; the numbers of the fit follow.
constexpr auto columns = std::to_array<GarmentColumn>({
    {"scene", of_row<&ResultRow::scene>},
    {"nodes", of_row<&ResultRow::nodes>},
    {"backend", of_row<&ResultRow::backend>},
    {"device", of_row<&ResultRow::device>},
    {"threads", of_row<&ResultRow::threads>},
    {"integrator", of_row<&ResultRow::integrator>},
    {"dt_s", of_row<&ResultRow::dt_s>},
    {"ms_per_iteration", of_row<&ResultRow::ms_per_step>},
    {"ms_per_iteration_low", of_row<&ResultRow::ms_per_step_low>},
    {"ms_per_iteration_high", of_row<&ResultRow::ms_per_step_high>},
    {"ns_per_iteration_and_vertex",
     [](const ResultRow& row) { return Cell(ns_per_node(row, row.ms_per_step)); }},
    {"speedup_vs_serial", of_row<&ResultRow::speedup_vs_serial>},
    {"dressing_iterations", of_dressing<&DressingRecord::iterations>},
    {"seamed_at", of_dressing<&DressingRecord::seamed_at>},
    {"settled", of_dressing<&DressingRecord::settled>},
    {"simulated_s", of_dressing<&DressingRecord::simulated_s>},
    {"dressing_s", of_dressing<&DressingRecord::wall_s>},
    {"dressing_ms_per_iteration",
     [](const ResultRow& row) { return row.dressing ? Cell(ms_per_iteration(*row.dressing)) : Cell(); }},
    {"verified", of_row<&ResultRow::verified>},
    {"status", of_row<&ResultRow::status>},
});

constexpr std::string_view within_suffix = "_within";

/// The longest of all fits: it has every number that the others have.
std::vector<FitNumberRecord> most_of_a_fit(std::span<const ResultRow* const> rows) {
  std::vector<FitNumberRecord> most;
  for (const ResultRow* row : rows)
    if (row->dressing && row->dressing->fit.size() > most.size()) most = row->dressing->fit;
  return most;
}

void add_fit(const std::vector<FitNumberRecord>& known, const ResultRow& row, std::vector<Cell>& cells) {
  for (const FitNumberRecord& number : known) {
    const FitNumberRecord* const found =
        row.dressing ? found_in(row.dressing->fit, number.name, &FitNumberRecord::name) : nullptr;
    cells.push_back(found ? Cell(found->value) : Cell());
    if (number.within) cells.push_back(found ? Cell(found->within) : Cell());
  }
}

std::vector<FitNumberRecord> read_fit(const CsvTable& table, std::size_t line) {
  std::vector<FitNumberRecord> fit;
  for (std::size_t column = columns.size(); column < table.header().size(); ++column) {
    const std::string& name = table.header()[column];
    if (!fit.empty() && name == fit.back().name + std::string(within_suffix)) {
      if (!table.text(line, column).empty()) fit.back().within = table.truth(line, column);
    } else {
      fit.push_back({name, table.optional_number(line, column), std::nullopt});
    }
  }
  std::erase_if(fit, [](const FitNumberRecord& number) { return !number.value && !number.within; });
  return fit;
}

}  // namespace

bool is_parallel(std::string_view backend) {
  const PublishedDressing* const published = published_dressing(backend);
  return published ? published->parallel : backend != baseline_name;
}

TableMaker garment_tables() {
  return [](std::span<const ResultRow> rows, const Provenance& provenance) {
    std::vector<ResultTable> tables;
    Rows dressed = rows_of_dressed_scenes(rows);
    if (dressed.empty()) return tables;
    const Layout layout(std::move(dressed));
    tables.push_back({"figure6", data_of(layout), page_of(layout, provenance)});
    return tables;
  };
}

std::string garment_csv(std::span<const ResultRow> rows) {
  const Rows dressed = rows_of_dressed_scenes(rows);
  if (dressed.empty()) return "";
  Table table;
  const std::vector<FitNumberRecord> fit = most_of_a_fit(dressed);
  for (const GarmentColumn& column : columns) table.columns.push_back({std::string(column.name)});
  for (const FitNumberRecord& number : fit) {
    table.columns.push_back({number.name});
    if (number.within) table.columns.push_back({number.name + std::string(within_suffix)});
  }
  for (const ResultRow* row : dressed) {
    std::vector<Cell>& cells = table.rows.emplace_back();
    for (const GarmentColumn& column : columns) cells.push_back(column.cell(*row));
    add_fit(fit, *row, cells);
  }
  return table_csv(table);
}

void read_dressings(const CsvTable& table, std::span<ResultRow> rows) {
  table.require_columns(mapped<std::string_view>(columns, &GarmentColumn::name));
  const std::size_t iterations = table.column("dressing_iterations"), seamed_at = table.column("seamed_at");
  for (std::size_t line = 0; line < table.size(); ++line) {
    if (table.text(line, iterations).empty()) continue;
    for (ResultRow& row : rows) {
      if (row.scene != table.text(line, 0) || row.backend != table.text(line, 2) ||
          row.integrator != table.text(line, 5))
        continue;
      DressingRecord& record = row.dressing.emplace();
      record.iterations = table.count(line, iterations);
      if (!table.text(line, seamed_at).empty()) record.seamed_at = table.count(line, seamed_at);
      record.settled = table.truth(line, table.column("settled"));
      record.simulated_s = table.number(line, table.column("simulated_s"));
      record.wall_s = table.number(line, table.column("dressing_s"));
      record.fit = read_fit(table, line);
    }
  }
}

}  // namespace mssim
