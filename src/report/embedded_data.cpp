#include "report/embedded_data.h"

#include <nlohmann/json.hpp>

#include "output/folders/provenance_file.h"
#include "output/tables/table_json.h"
#include "output/tables/timings_csv.h"
#include "report/sections.h"

namespace mssim {

std::string embedded_data(const ReportInput& input) {
  using nlohmann::ordered_json;
  ordered_json folders = ordered_json::array();
  for (const ReportFolder& folder : input.folders) {
    Table verdict{{{"outcome"}, {"sentence"}}, {}};
    for (const Finding& finding : findings_of(folder, input))
      verdict.rows.push_back({name_of(finding.outcome), finding.sentence});
    folders.push_back(
        {{"name", folder.name},
         {"problems", folder.problems},
         {"verdict", table_json(verdict)},
         {"timings", table_json(timings_table(folder.rows))},
         {"provenance",
          folder.provenance ? ordered_json::parse(provenance_text(*folder.provenance)) : ordered_json()}});
  }
  return json_text({{"made_by", input.made_by}, {"folders", std::move(folders)}});
}

}  // namespace mssim
