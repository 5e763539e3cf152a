#include "output/tables/scaling_table.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "output/tables/csv.h"
#include "output/tables/markdown.h"

namespace mssim {
namespace {

/// Nanoseconds a node and step of `ms`, none where there is no time.
std::optional<double> ns_per_node(const ResultRow& row, const std::optional<double>& ms) {
  if (!counts(row) || !ms) return std::nullopt;
  return *ms * 1e6 / static_cast<double>(row.nodes);
}

const ResultRow* find(std::span<const ResultRow> rows, const std::string& scene,
                      const std::string& integrator, const std::string& backend) {
  const auto row = std::ranges::find_if(rows, [&](const ResultRow& candidate) {
    return candidate.scene == scene && candidate.integrator == integrator && candidate.backend == backend;
  });
  return row == rows.end() ? nullptr : &*row;
}

/// Cost of a node over that of one of the same backend's on `base`.
std::optional<double> growth(std::span<const ResultRow> rows, const ResultRow& row, const std::string& base) {
  const ResultRow* small = find(rows, base, row.integrator, row.backend);
  if (!small) return std::nullopt;
  const auto here = ns_per_node(row, row.ms_per_step), there = ns_per_node(*small, small->ms_per_step);
  return here && there ? std::optional(*here / *there) : std::nullopt;
}

std::string as_csv(std::span<const ResultRow> rows, const std::string& base) {
  std::string csv = csv_line({"integrator", "backend", "scene", "nodes", "ms_per_step", "ns_per_node",
                              "ns_per_node_low", "ns_per_node_high", "ratio_to_" + base, "status"});
  for (const ResultRow& row : rows)
    csv += csv_line({row.integrator, row.backend, row.scene, std::to_string(row.nodes),
                     csv_number(row.ms_per_step), csv_number(ns_per_node(row, row.ms_per_step)),
                     csv_number(ns_per_node(row, row.ms_per_step_low)),
                     csv_number(ns_per_node(row, row.ms_per_step_high)), csv_number(growth(rows, row, base)),
                     status_of(row)});
  return csv;
}

/// The values of a member, each once, in the order of the rows.
std::vector<std::string> each_of(std::span<const ResultRow> rows, std::string ResultRow::*member) {
  std::vector<std::string> values;
  for (const ResultRow& row : rows)
    if (std::ranges::find(values, row.*member) == values.end()) values.push_back(row.*member);
  return values;
}

std::string cell(std::span<const ResultRow> rows, const ResultRow* row, const std::string& base,
                 int threads) {
  if (!row) return "–";
  const auto ns = ns_per_node(*row, row->ms_per_step);
  if (!ns) {
    const std::string status = status_of(*row);
    return one_cell(status.substr(0, status.find(':')));
  }
  const auto ratio = growth(rows, *row, base);
  return ("**" + three_digits(*ns) + "**").append(mark_of_excess(*row, threads)) +
         (ratio ? " (" + three_digits(*ratio) + "×)" : "");
}

std::string as_markdown(std::span<const ResultRow> rows, const std::string& base,
                        const Provenance& provenance) {
  std::vector<const ResultRow*> pointers;
  for (const ResultRow& row : rows) pointers.push_back(&row);
  std::ostringstream text;
  text
      << "# Scaling: cost of a node in ever larger cloths\n\n"
      << measured_on(pointers, provenance)
      << "Nanoseconds a node and step, medians; in brackets how many times as much as the same backend takes "
         "on `"
      << base << "`. Where a line stays at 1, the cost grows with the number of nodes and no faster.\n";
  const std::vector<std::string> scenes = each_of(rows, &ResultRow::scene);
  for (const std::string& integrator : each_of(rows, &ResultRow::integrator)) {
    text << "\n## " << integrator << "\n\n| backend |";
    for (const std::string& scene : scenes) {
      const auto row = std::ranges::find(rows, scene, &ResultRow::scene);
      text << " " << scene << "<br>" << grouped(row->nodes) << " |";
    }
    text << "\n|---|";
    for (std::size_t i = 0; i < scenes.size(); ++i) text << "---:|";
    text << "\n";
    for (const std::string& backend : each_of(rows, &ResultRow::backend)) {
      text << "| `" << backend << "` |";
      for (const std::string& scene : scenes) {
        const ResultRow* row = find(rows, scene, integrator, backend);
        text << " " << cell(rows, row, base, provenance.threads) << " |";
      }
      text << "\n";
    }
  }
  text << paragraph(legend_of_excess(pointers, provenance.threads)) << rows_without_a_time(pointers);
  return text.str();
}

}  // namespace

TableMaker scaling_tables(std::string base) {
  return [base = std::move(base)](std::span<const ResultRow> rows, const Provenance& provenance) {
    std::vector<ResultTable> tables;
    if (!rows.empty()) tables.push_back({"scaling", as_csv(rows, base), as_markdown(rows, base, provenance)});
    return tables;
  };
}

}  // namespace mssim
