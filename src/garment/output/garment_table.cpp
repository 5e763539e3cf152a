#include "garment/output/garment_table.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "output/tables/results.h"
#include "text/text.h"

namespace mssim {

std::vector<const ResultRow*> rows_of_dressed_scenes(std::span<const ResultRow> rows) {
  std::set<std::string_view> scenes;
  for (const ResultRow& row : rows)
    if (row.dressing) scenes.insert(row.scene);
  std::vector<const ResultRow*> found;
  for (const ResultRow& row : rows)
    if (scenes.contains(row.scene)) found.push_back(&row);
  return found;
}

std::optional<double> ms_per_iteration(const DressingRecord& dressing) {
  if (dressing.iterations == 0) return std::nullopt;
  return 1e3 * dressing.wall_s / static_cast<double>(dressing.iterations);
}

namespace {

using Rows = std::vector<const ResultRow*>;
/// A line of a table: a backend with an integrator.
using Line = std::pair<std::string, std::string>;

/// The rows laid out: scenes are columns, by their number of vertices, and combinations that have a time or a
/// dressing anywhere are lines.
class Layout {
 public:
  explicit Layout(Rows rows) : rows_(std::move(rows)) {
    for (const ResultRow* row : rows_) {
      if (std::ranges::find(scenes_, row->scene, &ResultRow::scene) == scenes_.end()) scenes_.push_back(row);
      const Line line(row->backend, row->integrator);
      if (row->dressing && std::ranges::find(lines_, line) == lines_.end()) lines_.push_back(line);
    }
    std::ranges::stable_sort(scenes_, {}, &ResultRow::nodes);
  }

  const Rows& rows() const { return rows_; }
  const Rows& scenes() const { return scenes_; }
  const std::vector<Line>& lines() const { return lines_; }
  const ResultRow* find(const ResultRow& scene, const Line& line) const {
    return find_row(rows_, scene.scene, line.first, line.second);
  }

 private:
  Rows rows_;
  Rows scenes_;  ///< the first row of each
  std::vector<Line> lines_;
};

bool is_baseline(const Line& line) { return line.first == baseline_name; }

/// A cell of the table of times.
Cell time_cell(RowPointers rows, const ResultRow& row) {
  const std::optional<double> ms = counted_ms(row);
  Cell cell = measured_cell(&row, ms);
  if (ms && row.speedup_vs_serial && row.backend != baseline_name)
    cell.suffix.append(in_brackets(*row.speedup_vs_serial)).append(mark_of_speedup(rows, row));
  return cell;
}

Cell vertex_cell(RowPointers /*rows*/, const ResultRow& row) { return ns_per_node(row, row.ms_per_step); }

Cell dressing_cell(RowPointers /*rows*/, const ResultRow& row) {
  if (!row.dressing) return {};
  return three_digits(row.dressing->wall_s) + " s\n" + grouped(row.dressing->iterations);
}

using MakeCell = Cell (*)(RowPointers rows, const ResultRow& row);

Table table_of(const Layout& layout, const Provenance& provenance, const std::string& title, MakeCell make) {
  Table table{{{title}}, {}};
  for (const ResultRow* scene : layout.scenes()) table.columns.push_back(scene_column(*scene));
  for (const Line& line : layout.lines()) {
    std::vector<Cell>& cells = table.rows.emplace_back();
    cells.emplace_back((is_baseline(line) ? "without: " : "with: ") +
                       backend_label(layout.rows(), line.first, provenance));
    for (const ResultRow* scene : layout.scenes()) {
      const ResultRow* row = layout.find(*scene, line);
      Cell& cell = cells.emplace_back(row ? make(layout.rows(), *row) : Cell());
      if (row) cell.suffix += mark_of_excess(*row, provenance);
    }
  }
  return table;
}

Document page_of(const Layout& layout, const Provenance& provenance) {
  Document page{
      Heading{1, "Figure 6 of Vassilev: milliseconds an iteration against vertices of jeans"},
      measured_on(layout.rows(), provenance),
      Paragraph{
          "One iteration of Algorithm 1, medians, of jeans that hang draped on the body: springs, joints, "
          "collision with the body and the correction of velocities are at work. In brackets how many "
          "times as fast as without parallelisation. The paper shows its own times as curves, without "
          "numbers, from other machines."},
      table_of(layout, provenance, "milliseconds an iteration", time_cell),
      Paragraph{"Nanoseconds an iteration and vertex, of the same samples:"},
      table_of(layout, provenance, "nanoseconds", vertex_cell),
      Paragraph{
          "The whole dressing, once: seconds and iterations from flat panels to jeans that hang settled. "
          "`garment.csv` says how each fits."},
      table_of(layout, provenance, "dressing", dressing_cell)};
  add_sentence(page, legend_of_ratios(page));
  add_sentence(page, legend_of_excess(layout.rows(), provenance));
  add_sentence(page, reason_without_speedups(layout.rows()));
  add_rows_without_a_time(page, layout.rows());
  return page;
}

Table data_of(const Layout& layout) {
  Table table{{{"backend"}, {"integrator"}, {"parallel"}, {"quantity"}}, {}};
  std::vector<Cell>& vertices = table.rows.emplace_back();
  vertices = {{}, {}, {}, "vertices"};
  for (const ResultRow* scene : layout.scenes()) {
    table.columns.push_back({scene->scene});
    vertices.emplace_back(scene->nodes);
  }
  for (const Line& line : layout.lines()) {
    const auto add = [&](std::string_view quantity, auto&& value) {
      std::vector<Cell>& cells = table.rows.emplace_back();
      cells = {line.first, line.second, is_baseline(line) ? "without" : "with", quantity};
      for (const ResultRow* scene : layout.scenes()) {
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
    add("dressing_s",
        [](const ResultRow& row) { return row.dressing ? Number(row.dressing->wall_s) : Number(); });
    add("dressing_iterations",
        [](const ResultRow& row) { return row.dressing ? Cell(row.dressing->iterations) : Cell(); });
  }
  return table;
}

}  // namespace

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

}  // namespace mssim
