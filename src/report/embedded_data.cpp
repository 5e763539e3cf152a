#include "report/embedded_data.h"

#include "output/folders/provenance_file.h"
#include "output/tables/table.h"
#include "output/tables/timings_csv.h"
#include "report/sections.h"
#include "text/text.h"

namespace mssim {
namespace {

/// The points of a guide as charts have them.
Table points_of(const FoundGuide& guide) {
  Table table;
  for (const GuidePoint& point : guide.points)
    table.add({{"scene", point.scene},
               {"integrator", point.integrator},
               {"backend", point.backend},
               {"dt_s", point.dt_s},
               {"position_error", point.position_error},
               {"wall_s_per_s", point.wall_s_per_s},
               {"force_evaluations_per_s", point.force_evaluations_per_s},
               {"diverged", point.diverged},
               {"on_front", point.on_front},
               {"status", point.status}});
  return table;
}

std::string json_of(const ReportFolder& folder, const ReportInput& input) {
  Table verdict{{{"outcome"}, {"sentence"}}, {}};
  for (const Finding& finding : findings_of(folder, input))
    verdict.rows.push_back({name_of(finding.outcome), finding.sentence});
  std::vector<std::string> problems;
  for (const std::string& problem : folder.problems) problems.push_back(json_string(problem));
  return "{\"name\": " + json_string(folder.name) + ", \"problems\": [" + join(problems, ", ") +
         "],\n\"verdict\": " + to_text(verdict, ListingFormat::json) +
         ", \"timings\": " + to_text(timings_table(folder.rows), ListingFormat::json) +
         (folder.guide ? ", \"guide\": " + to_text(points_of(*folder.guide), ListingFormat::json) : "") +
         ", \"provenance\": " + (folder.provenance ? provenance_text(*folder.provenance) : "null") + "}";
}

}  // namespace

std::string embedded_data(const ReportInput& input) {
  std::vector<std::string> folders;
  for (const ReportFolder& folder : input.folders) folders.push_back(json_of(folder, input));
  return "{\"made_by\": " + json_string(input.made_by) + ", \"folders\": [\n" + join(folders, ",\n") +
         "\n]}\n";
}

}  // namespace mssim
