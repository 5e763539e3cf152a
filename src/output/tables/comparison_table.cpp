#include <nlohmann/json.hpp>

#include "output/tables/results.h"
#include "text/text.h"

namespace mssim {
namespace {

/// The samples that an undecided row needs, or why a row is lost; empty for others.
Cell remark(const ComparedRow& row) {
  if (row.verdict == Verdict::lost) return row.reason;
  if (row.verdict != Verdict::undecided) return {};
  if (!row.samples_needed) return "many samples would be needed";
  return row.ratio->covers ? fmt::format("{} samples per side would decide", *row.samples_needed)
                           : fmt::format("at least {} samples per side are needed", *row.samples_needed);
}

Cell ratio_cell(const ComparedRow& row, bool utf8 = true) {
  if (!row.ratio) return {};
  Cell cell = row.ratio->ratio;
  const std::string_view mark = mark_of_ratio(row.ratio->ratio, *row.new_ms, *row.base_ms);
  cell.suffix = mark.empty() || utf8 ? mark : ascii_ratio_mark;
  return cell;
}

/// For terminals and programs.
Table rows_of(const RunComparison& comparison, bool utf8) {
  Table table;
  for (const ComparedRow& row : comparison.rows) {
    const bool has_interval = row.ratio && row.ratio->covers;
    table.add({{"scene", row.scene},
               {"backend", row.backend},
               {"integrator", row.integrator},
               {"base_ms", row.base_ms},
               {"new_ms", row.new_ms},
               {"ratio", ratio_cell(row, utf8)},
               {"low", has_interval ? Cell(row.ratio->low) : Cell()},
               {"high", has_interval ? Cell(row.ratio->high) : Cell()},
               {"p", row.ratio ? Cell(row.ratio->p) : Cell()},
               {"verdict", name_of(row.verdict)},
               {"remark", remark(row)}});
  }
  return table;
}

Table means_of(const RunComparison& comparison) {
  Table table;
  for (const MeanRatio& mean : comparison.means)
    table.add({{"backend", mean.backend.empty() ? "all" : mean.backend},
               {"rows", mean.rows},
               {"geometric_mean_ratio", mean.ratio}});
  return table;
}

/// The verdict and its remark.
Cell verdict_cell(const ComparedRow& row) {
  Cell cell = name_of(row.verdict);
  cell.strong = row.verdict != Verdict::same && row.verdict != Verdict::undecided;
  if (const Cell why = remark(row); const auto* text = std::get_if<std::string>(&why.value))
    cell.suffix = ": " + *text;
  return cell;
}

}  // namespace

Document comparison_page(const RunComparison& comparison) {
  Table rows;
  for (const ComparedRow& row : comparison.rows)
    rows.add(
        {{"scene", row.scene},
         {"backend", '`' + row.backend + '`'},
         {"integrator", row.integrator},
         {"BASE ms", row.base_ms},
         {"NEW ms", row.ratio ? Cell(row.new_ms) : Cell()},
         {"NEW / BASE", ratio_cell(row)},
         {"95 % interval",
          row.ratio && row.ratio->covers ? Cell(interval_text(row.ratio->low, row.ratio->high)) : Cell()},
         {"verdict", verdict_cell(row)}});
  Table means;
  for (const MeanRatio& mean : comparison.means)
    means.add({{"geometric mean of", mean.backend.empty() ? "all" : '`' + mean.backend + '`'},
               {"rows", mean.rows},
               {"NEW / BASE", mean.ratio}});
  Document page{rows};
  add_sentence(page, legend_of_ratios(page));
  if (!comparison.means.empty()) page.emplace_back(means);
  return page;
}

std::string to_text(const RunComparison& comparison, ComparisonFormat format, bool utf8) {
  if (format == ComparisonFormat::markdown) return markdown(comparison_page(comparison));
  const Table rows = rows_of(comparison, utf8), means = means_of(comparison);
  if (format == ComparisonFormat::json) {
    nlohmann::ordered_json json_rows = table_json(rows);
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
      json_rows[i]["base_samples_ms"] = comparison.rows[i].base_samples_ms;
      json_rows[i]["new_samples_ms"] = comparison.rows[i].new_samples_ms;
    }
    return json_text({{"threshold", comparison.threshold},
                      {"regression", has_regression(comparison)},
                      {"rows", json_rows},
                      {"geometric_means", table_json(means)}});
  }
  const std::string rows_text = to_text(rows), means_text = to_text(means);
  const std::string legend = legend_of_ratios(rows_text);
  return rows_text + (means_text.empty() ? "" : "\n" + means_text) + (legend.empty() ? "" : legend + "\n");
}

}  // namespace mssim
