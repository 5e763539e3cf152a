#include "commands/bench/bench_summary.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "output/tables/github_table.h"
#include "output/tables/ratio_mark.h"
#include "output/tables/result_table.h"
#include "output/tables/row_table.h"
#include "output/tables/table.h"
#include "text/text.h"

namespace mssim {
namespace {

std::string text_of(const Table& table, SummaryFormat format) {
  if (table.rows.empty() || format == SummaryFormat::github) return "";
  return to_text(table, format == SummaryFormat::csv    ? ListingFormat::csv
                        : format == SummaryFormat::json ? ListingFormat::json
                                                        : ListingFormat::table);
}

/// "opencl, hybrid ran on DEVICE", for each OpenCL device.
std::vector<std::string> devices_of(RowPointers rows) {
  std::map<std::string_view, std::vector<std::string>> backends;
  for (const ResultRow* row : rows) {
    const std::string_view device = opencl_device(*row);
    if (device.empty()) continue;
    std::vector<std::string>& names = backends[device];
    if (std::ranges::find(names, row->backend) == names.end()) names.push_back(row->backend);
  }
  std::vector<std::string> sentences;
  for (const auto& [device, names] : backends)
    sentences.push_back((join(names, ", ") + " ran on ").append(device));
  return sentences;
}

/// What stands below `table`, a row_table.
std::string remarks(RowPointers rows, std::string_view table, const Provenance& provenance,
                    std::optional<int> width) {
  std::vector<std::string> sentences = devices_of(rows);
  sentences.insert(sentences.end(), {legend_of_ratios(table), legend_of_excess(rows, provenance),
                                     reason_without_speedups(rows)});
  std::string text;
  for (const std::string& sentence : sentences)
    if (!sentence.empty())
      text += wrapped(sentence, width ? static_cast<std::size_t>(*width) : SIZE_MAX, "") + '\n';
  return text;
}

}  // namespace

std::string summary(std::span<const ResultRow> rows, SummaryFormat format, const Provenance& provenance,
                    const Terminal& terminal) {
  if (format == SummaryFormat::github) return to_text(github_table(rows), ListingFormat::json);
  if (format == SummaryFormat::table) {
    const std::vector<const ResultRow*> pointers = pointers_to(rows);
    const std::string text = row_table(pointers, provenance, terminal);
    return text + remarks(pointers, text, provenance, terminal.width);
  }
  Table table;
  for (const ResultRow& row : rows)
    table.add({{"scene", row.scene},
               {"nodes", row.nodes},
               {"springs_published", row.springs_published},
               {"integrator", row.integrator},
               {"backend", row.backend},
               {"threads", row.threads},
               {"ms_per_step", row.ms_per_step},
               {"low", row.ms_per_step_low},
               {"high", row.ms_per_step_high},
               {"speedup", row.speedup_vs_serial},
               {"paper_ms", row.paper_ms},
               {"roofline", row.roofline_fraction},
               {"position_error", row.position_error},
               {"verified", row.verified},
               {"status", row.status}});
  return text_of(table, format);
}

std::string summary(std::span<const StructureRow> rows, SummaryFormat format) {
  Table table;
  for (const StructureRow& row : rows)
    table.add({{"scene", row.scene},
               {"nodes", row.nodes},
               {"springs_unique", row.springs_unique},
               {"springs_published", row.springs_published},
               {"tetrahedra", row.tetrahedra},
               {"smallest_dihedral_angle_deg", row.smallest_dihedral_angle_deg}});
  return text_of(table, format);
}

}  // namespace mssim
