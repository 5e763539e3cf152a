#include "output/tables/comparison_table.h"

#include <algorithm>
#include <sstream>

#include "output/tables/listing.h"
#include "output/tables/markdown.h"

namespace mssim {
namespace {

using nlohmann::ordered_json;

/// The samples that an undecided row would need, why a row is lost; null for others.
ordered_json remark(const ComparedRow& row) {
  if (row.verdict == Verdict::lost) return row.reason;
  if (row.verdict != Verdict::undecided) return nullptr;
  return row.samples_needed ? std::to_string(*row.samples_needed) + " samples a side would decide"
                            : "many samples would be needed";
}

Listing rows_of(const RunComparison& comparison) {
  Listing listing;
  for (const ComparedRow& row : comparison.rows) {
    const auto of_ratio = [&](double RatioEstimate::*value) {
      return row.ratio ? ordered_json((*row.ratio).*value) : ordered_json();
    };
    listing.push_back({{"scene", row.scene},
                       {"backend", row.backend},
                       {"integrator", row.integrator},
                       {"base_ms", row.base_ms},
                       {"new_ms", row.new_ms ? ordered_json(*row.new_ms) : ordered_json()},
                       {"ratio", of_ratio(&RatioEstimate::ratio)},
                       {"low", of_ratio(&RatioEstimate::low)},
                       {"high", of_ratio(&RatioEstimate::high)},
                       {"p", of_ratio(&RatioEstimate::p)},
                       {"verdict", name_of(row.verdict)},
                       {"remark", remark(row)}});
  }
  return listing;
}

Listing means_of(const RunComparison& comparison) {
  Listing listing;
  for (const MeanRatio& mean : comparison.means)
    listing.push_back({{"backend", mean.backend.empty() ? "all" : mean.backend},
                       {"rows", mean.rows},
                       {"geometric_mean_ratio", mean.ratio}});
  return listing;
}

std::string as_json(const RunComparison& comparison) {
  const ordered_json document{{"threshold", comparison.threshold},
                              {"regression", has_regression(comparison)},
                              {"rows", rows_of(comparison)},
                              {"geometric_means", means_of(comparison)}};
  return document.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

std::string as_markdown(const RunComparison& comparison) {
  std::ostringstream text;
  text << "| scene | backend | integrator | BASE ms | NEW ms | NEW / BASE | 95 % interval | verdict |\n"
          "|---|---|---|---:|---:|---:|---|---|\n";
  for (const ComparedRow& row : comparison.rows) {
    text << "| " << one_cell(row.scene) << " | `" << row.backend << "` | " << row.integrator << " | "
         << three_digits(row.base_ms) << " | ";
    if (row.ratio)
      text << three_digits(*row.new_ms) << " | " << three_digits(row.ratio->ratio) << " | "
           << three_digits(row.ratio->low) << " to " << three_digits(row.ratio->high);
    else
      text << "– | – | –";
    const bool plain = row.verdict == Verdict::same || row.verdict == Verdict::undecided;
    text << " | " << (plain ? "" : "**") << name_of(row.verdict) << (plain ? "" : "**");
    if (const ordered_json why = remark(row); !why.is_null())
      text << ": " << one_cell(why.get<std::string>());
    text << " |\n";
  }
  if (comparison.means.empty()) return text.str();
  text << "\n| geometric mean of | rows | NEW / BASE |\n|---|---:|---:|\n";
  for (const MeanRatio& mean : comparison.means)
    text << "| " << (mean.backend.empty() ? "all" : '`' + mean.backend + '`') << " | " << mean.rows << " | "
         << three_digits(mean.ratio) << " |\n";
  return text.str();
}

}  // namespace

std::string to_text(const RunComparison& comparison, ComparisonFormat format) {
  if (format == ComparisonFormat::json) return as_json(comparison);
  if (format == ComparisonFormat::markdown) return as_markdown(comparison);
  const std::string means = to_text(means_of(comparison), ListingFormat::table);
  return to_text(rows_of(comparison), ListingFormat::table) + (means.empty() ? "" : "\n" + means);
}

}  // namespace mssim
