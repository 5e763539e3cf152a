#include "garment/output/garment_csv.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "garment/output/garment_table.h"
#include "output/tables/results.h"
#include "output/tables/table.h"

namespace mssim {
namespace {

/// A column of garment.csv that every row has.
struct GarmentColumn {
  std::string_view name;
  Cell (*write)(const ResultRow& row);
  /// Reads what only this file has; null for what timings.csv has, too.
  void (*read)(DressingRecord& record, const CsvTable& table, std::size_t line, std::size_t column) = nullptr;
};

/// A value of the row's dressing; nothing where it has none.
template <class Value>
Cell of_dressing(const ResultRow& row, Value DressingRecord::*value) {
  return row.dressing ? Cell((*row.dressing).*value) : Cell();
}

/// The TABLE of columns, in their order; the numbers of the fit follow.
constexpr std::size_t iterations_column = 12;
constexpr auto columns = std::to_array<GarmentColumn>({
    {"scene", [](const ResultRow& row) { return Cell(row.scene); }},
    {"nodes", [](const ResultRow& row) { return Cell(row.nodes); }},
    {"backend", [](const ResultRow& row) { return Cell(row.backend); }},
    {"device", [](const ResultRow& row) { return Cell(row.device); }},
    {"threads", [](const ResultRow& row) { return Cell(row.threads); }},
    {"integrator", [](const ResultRow& row) { return Cell(row.integrator); }},
    {"dt_s", [](const ResultRow& row) { return Cell(row.dt_s); }},
    {"ms_per_iteration", [](const ResultRow& row) { return Cell(row.ms_per_step); }},
    {"ms_per_iteration_low", [](const ResultRow& row) { return Cell(row.ms_per_step_low); }},
    {"ms_per_iteration_high", [](const ResultRow& row) { return Cell(row.ms_per_step_high); }},
    {"ns_per_iteration_and_vertex",
     [](const ResultRow& row) { return Cell(ns_per_node(row, row.ms_per_step)); }},
    {"speedup_vs_serial", [](const ResultRow& row) { return Cell(row.speedup_vs_serial); }},
    {"dressing_iterations",
     [](const ResultRow& row) { return of_dressing(row, &DressingRecord::iterations); },
     [](DressingRecord& d, const CsvTable& table, std::size_t l, std::size_t c) {
       d.iterations = table.count(l, c);
     }},
    {"seamed_at", [](const ResultRow& row) { return of_dressing(row, &DressingRecord::seamed_at); },
     [](DressingRecord& d, const CsvTable& table, std::size_t l, std::size_t c) {
       if (!table.text(l, c).empty()) d.seamed_at = table.count(l, c);
     }},
    {"settled", [](const ResultRow& row) { return of_dressing(row, &DressingRecord::settled); },
     [](DressingRecord& d, const CsvTable& table, std::size_t l, std::size_t c) {
       d.settled = table.truth(l, c);
     }},
    {"simulated_s", [](const ResultRow& row) { return of_dressing(row, &DressingRecord::simulated_s); },
     [](DressingRecord& d, const CsvTable& table, std::size_t l, std::size_t c) {
       d.simulated_s = table.number(l, c);
     }},
    {"dressing_s", [](const ResultRow& row) { return of_dressing(row, &DressingRecord::wall_s); },
     [](DressingRecord& d, const CsvTable& table, std::size_t l, std::size_t c) {
       d.wall_s = table.number(l, c);
     }},
    {"dressing_ms_per_iteration",
     [](const ResultRow& row) { return row.dressing ? Cell(ms_per_iteration(*row.dressing)) : Cell(); }},
    {"verified", [](const ResultRow& row) { return Cell(row.verified); }},
    {"status", [](const ResultRow& row) { return Cell(row.status); }},
});
static_assert(columns[iterations_column].name == "dressing_iterations");

constexpr std::string_view within_suffix = "_within";

/// The numbers of all fits: a garment that has fewer has none that the one with the most lacks.
std::vector<FitNumberRecord> most_of_a_fit(std::span<const ResultRow* const> rows) {
  std::vector<FitNumberRecord> most;
  for (const ResultRow* row : rows)
    if (row->dressing && row->dressing->fit.size() > most.size()) most = row->dressing->fit;
  return most;
}

void add_fit(const std::vector<FitNumberRecord>& known, const ResultRow& row, std::vector<Cell>& cells) {
  for (const FitNumberRecord& number : known) {
    const FitNumberRecord* found = nullptr;
    if (row.dressing)
      for (const FitNumberRecord& candidate : row.dressing->fit)
        if (candidate.name == number.name) found = &candidate;
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

std::string garment_csv(std::span<const ResultRow> rows) {
  const std::vector<const ResultRow*> dressed = rows_of_dressed_scenes(rows);
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
    for (const GarmentColumn& column : columns) cells.push_back(column.write(*row));
    add_fit(fit, *row, cells);
  }
  return table_csv(table);
}

void read_dressings(const CsvTable& table, std::span<ResultRow> rows) {
  std::vector<std::string_view> names;
  for (const GarmentColumn& column : columns) names.push_back(column.name);
  table.require_columns(names);
  for (std::size_t line = 0; line < table.size(); ++line) {
    if (table.text(line, iterations_column).empty()) continue;
    for (ResultRow& row : rows) {
      if (row.scene != table.text(line, 0) || row.backend != table.text(line, 2) ||
          row.integrator != table.text(line, 5))
        continue;
      DressingRecord& record = row.dressing.emplace();
      for (std::size_t column = 0; column < columns.size(); ++column)
        if (columns.at(column).read != nullptr) columns.at(column).read(record, table, line, column);
      record.fit = read_fit(table, line);
    }
  }
}

}  // namespace mssim
