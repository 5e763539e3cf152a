#include "commands/bench/bench_summary.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "output/tables/github_json.h"
#include "output/tables/listing.h"
#include "output/tables/result_table.h"

namespace mssim {
namespace {

std::string text_of(const Listing& listing, SummaryFormat format) {
  if (listing.empty() || format == SummaryFormat::github) return "";
  return to_text(listing, format == SummaryFormat::csv    ? ListingFormat::csv
                          : format == SummaryFormat::json ? ListingFormat::json
                                                          : ListingFormat::table);
}

/// What stands below a table of rows.
std::string remarks(std::span<const ResultRow> rows, int threads) {
  std::vector<const ResultRow*> pointers;
  for (const ResultRow& row : rows) pointers.push_back(&row);
  std::string text;
  for (const std::string& sentence : {legend_of_excess(pointers, threads), reason_without_speedups(pointers)})
    if (!sentence.empty()) text += sentence + '\n';
  return text;
}

}  // namespace

std::string summary(std::span<const ResultRow> rows, SummaryFormat format, int threads) {
  if (format == SummaryFormat::github)
    return github_json(rows).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
  const auto number = [](const auto& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
  };
  const auto threads_cell = [&](const ResultRow& row) -> nlohmann::ordered_json {
    if (format != SummaryFormat::table || !exceeds(row, threads)) return row.threads;
    return std::to_string(row.threads).append(mark_of_excess(row, threads));
  };
  Listing listing;
  for (const ResultRow& row : rows)
    listing.push_back({{"scene", row.scene},
                       {"nodes", row.nodes},
                       {"springs_published", number(row.springs_published)},
                       {"integrator", row.integrator},
                       {"backend", row.backend},
                       {"threads", threads_cell(row)},
                       {"ms_per_step", number(row.ms_per_step)},
                       {"low", number(row.ms_per_step_low)},
                       {"high", number(row.ms_per_step_high)},
                       {"speedup", number(row.speedup_vs_serial)},
                       {"paper_ms", number(row.paper_ms)},
                       {"roofline", number(row.roofline_fraction)},
                       {"position_error", number(row.position_error)},
                       {"verified", row.verified},
                       {"status", row.status}});
  return text_of(listing, format) + (format == SummaryFormat::table ? remarks(rows, threads) : "");
}

std::string summary(std::span<const StructureRow> rows, SummaryFormat format) {
  Listing listing;
  for (const StructureRow& row : rows)
    listing.push_back({{"scene", row.scene},
                       {"nodes", row.nodes},
                       {"springs_unique", row.springs_unique},
                       {"springs_published", row.springs_published},
                       {"tetrahedra", row.tetrahedra},
                       {"smallest_dihedral_angle_deg", row.smallest_dihedral_angle_deg}});
  return text_of(listing, format);
}

}  // namespace mssim
