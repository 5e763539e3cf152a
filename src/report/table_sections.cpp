#include <algorithm>
#include <exception>
#include <map>
#include <set>

#include "report/html.h"
#include "report/report_charts.h"
#include "report/sections.h"
#include "report/times_as_fast.h"
#include "text/text.h"

namespace mssim {
namespace {

std::string interval(double low, double high) { return three_digits(low) + " to " + three_digits(high); }

/// The words say it, the sign only helps to see it.
std::string verified_mark(const ResultRow& row) {
  if (counts(row)) return "✓ yes";
  return row.status == "ok" ? "✗ **no**" : "– " + row.status.substr(0, row.status.find(':'));
}

Table times_of(const std::vector<const ResultRow*>& rows, std::span<const ResultRow> all) {
  Table table{{{"scene"},
               {"integrator"},
               {"backend"},
               {"threads"},
               {"time of a step (ms)", Align::right},
               {"95 % interval (ms)", Align::right},
               {"speed-up", Align::right, "×"},
               {"95 % interval", Align::right},
               {"published (ms)", Align::right},
               {"of the roof (%)", Align::right},
               {"verified"}},
              {}};
  const std::vector<const ResultRow*> pointers = pointers_to(all);
  for (const ResultRow* row : rows) {
    const ResultRow* serial = find_row(pointers, row->scene, "serial", row->integrator);
    const auto speedup = serial && serial != row ? times_as_fast(*row, *serial) : std::nullopt;
    const bool shown = counts(*row);
    Cell published = row->paper_ms;
    published.exact = true;
    table.rows.push_back({row->scene, row->integrator, "`" + row->backend + "`",
                          row->threads > 0 ? Cell(row->threads) : Cell(),
                          shown ? Cell(row->ms_per_step) : Cell(),
                          shown && row->ms_per_step_low && row->ms_per_step_high
                              ? Cell(interval(*row->ms_per_step_low, *row->ms_per_step_high))
                              : Cell(),
                          speedup ? Cell(speedup->ratio) : Cell(),
                          speedup ? Cell(interval(speedup->low, speedup->high)) : Cell(), published,
                          shown && row->roofline_fraction ? Cell(100 * *row->roofline_fraction) : Cell(),
                          verified_mark(*row)});
  }
  return table;
}

/// Those of the largest scene of each kind.
std::vector<const ResultRow*> headline_rows(std::span<const ResultRow> rows) {
  std::map<ContentKind, const ResultRow*> largest;
  for (const ResultRow& row : rows) {
    if (!counts(row)) continue;
    const ResultRow*& known = largest[kind_of(row)];
    if (!known || row.nodes > known->nodes) known = &row;
  }
  std::set<std::string_view> scenes;
  for (const auto& [kind, row] : largest) scenes.insert(row->scene);
  std::vector<const ResultRow*> chosen;
  for (const ResultRow& row : rows)
    if (scenes.contains(row.scene)) chosen.push_back(&row);
  return chosen;
}

}  // namespace

std::string headline_section(const ReportInput& input) {
  std::string text =
      "<p>The largest scene of each kind. Times are medians of the rounds; intervals hold the true median in "
      "95 "
      "% of the cases (with fewer than six rounds they are the smallest and the largest sample). Speed-ups "
      "are "
      "over <code>serial</code>, medians of the ratios within each round.</p>\n";
  for (const ReportFolder& folder : input.folders) {
    text += folder_heading(input, folder);
    if (folder.rows.empty()) {
      text += "<p>There are no rows.</p>\n";
      continue;
    }
    text += html_of(times_of(headline_rows(folder.rows), folder.rows));
    text += "<details><summary>All " + pluralize(folder.rows.size(), "row") + "</summary>\n" +
            html_of(times_of(pointers_to(folder.rows), folder.rows)) + "</details>\n";
  }
  return text;
}

std::string published_section(const ReportInput& input) {
  std::string text;
  for (const ReportFolder& folder : input.folders) {
    text += folder_heading(input, folder);
    std::vector<ResultTable> tables;
    if (input.tables) tables = input.tables(folder.rows, folder.provenance.value_or(Provenance()));
    for (const ResultTable& table : tables) text += html_of(table.page, 4);
    if (tables.empty()) text += "<p>No row of this folder belongs into a published table.</p>\n";
  }
  return text;
}

}  // namespace mssim
