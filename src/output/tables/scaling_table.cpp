#include "output/tables/scaling_table.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace mssim {
namespace {

/// Cost of a node over that of one of the same backend's on `base`.
std::optional<double> growth(RowPointers rows, const ResultRow& row, const std::string& base) {
  const ResultRow* small = find_row(rows, base, row.backend, row.integrator);
  if (!small) return std::nullopt;
  const auto here = ns_per_node(row, row.ms_per_step), there = ns_per_node(*small, small->ms_per_step);
  return here && there ? std::optional(*here / *there) : std::nullopt;
}

Table data_of(RowPointers rows, const std::string& base) {
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
               {"ratio_to_" + base, growth(rows, *row, base)},
               {"status", status_of(*row)}});
  return table;
}

/// The values of a member, each once, in the order of the rows.
std::vector<std::string> each_of(RowPointers rows, std::string ResultRow::*member) {
  std::vector<std::string> values;
  for (const ResultRow* row : rows)
    if (std::ranges::find(values, row->*member) == values.end()) values.push_back(row->*member);
  return values;
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
      Heading{1, "Scaling: cost of a node in ever larger cloths"}, measured_on(rows, provenance),
      Paragraph{"Nanoseconds a node and step, medians; in brackets how many times as much as the same "
                "backend takes on `" +
                base + "`. Where a line stays at 1, the cost grows with the number of nodes and no faster."}};
  const std::vector<std::string> scenes = each_of(rows, &ResultRow::scene);
  std::vector<Column> columns{{"backend"}};
  for (const std::string& scene : scenes) {
    const auto row = std::ranges::find(rows, scene, &ResultRow::scene);
    columns.push_back(scene_column(**row));
  }
  for (const std::string& integrator : each_of(rows, &ResultRow::integrator)) {
    Table table{columns, {}};
    for (const std::string& backend : each_of(rows, &ResultRow::backend)) {
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

}  // namespace

TableMaker scaling_tables(std::string base) {
  return [base = std::move(base)](std::span<const ResultRow> rows, const Provenance& provenance) {
    std::vector<ResultTable> tables;
    const std::vector<const ResultRow*> pointers = pointers_to(rows);
    if (!rows.empty())
      tables.push_back({"scaling", data_of(pointers, base), page_of(pointers, base, provenance)});
    return tables;
  };
}

}  // namespace mssim
