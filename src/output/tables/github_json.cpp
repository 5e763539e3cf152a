#include "output/tables/github_json.h"

#include <nlohmann/json.hpp>
#include <string>

#include "output/tables/csv.h"
#include "text/counted.h"

namespace mssim {

nlohmann::ordered_json github_json(std::span<const ResultRow> rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ResultRow& row : rows) {
    if (row.status != "ok" || !row.ms_per_step) continue;
    list.push_back(
        {{"name", row.scene + '/' + row.backend + '/' + row.integrator},
         {"unit", "ms/step"},
         {"value", *row.ms_per_step},
         {"range", csv_number(row.ms_per_step_low) + " to " + csv_number(row.ms_per_step_high)},
         {"extra", row.device + ", " + counted(static_cast<std::uint64_t>(row.threads), "thread")}});
  }
  return list;
}

}  // namespace mssim
