#include "report/embedded_data.h"

#include "output/folders/provenance_file.h"
#include "output/tables/table_json.h"
#include "output/tables/timings_csv.h"
#include "report/sections.h"
#include "text/joined.h"

namespace mssim {
namespace {

std::string json_of(const ReportFolder& folder, const ReportInput& input) {
  Table verdict{{{"outcome"}, {"sentence"}}, {}};
  for (const Finding& finding : findings_of(folder, input))
    verdict.rows.push_back({name_of(finding.outcome), finding.sentence});
  std::vector<std::string> problems;
  for (const std::string& problem : folder.problems) problems.push_back(json_string(problem));
  return "{\"name\": " + json_string(folder.name) + ", \"problems\": [" + joined(problems, ", ") +
         "],\n\"verdict\": " + table_json_text(verdict) +
         ", \"timings\": " + table_json_text(timings_table(folder.rows)) +
         ", \"provenance\": " + (folder.provenance ? provenance_text(*folder.provenance) : "null") + "}";
}

}  // namespace

std::string embedded_data(const ReportInput& input) {
  std::vector<std::string> folders;
  for (const ReportFolder& folder : input.folders) folders.push_back(json_of(folder, input));
  return "{\"made_by\": " + json_string(input.made_by) + ", \"folders\": [\n" + joined(folders, ",\n") +
         "\n]}\n";
}

}  // namespace mssim
