#include "output/tables/github_table.h"

#include <string>

#include "output/tables/csv.h"
#include "text/text.h"

namespace mssim {

Table github_table(std::span<const ResultRow> rows) {
  Table table;
  for (const ResultRow& row : rows) {
    if (row.status != "ok" || !row.ms_per_step) continue;
    table.add({{"name", row.scene + '/' + row.backend + '/' + row.integrator},
               {"unit", "ms/step"},
               {"value", *row.ms_per_step},
               {"range", csv_number(row.ms_per_step_low) + " to " + csv_number(row.ms_per_step_high)},
               {"extra", row.device + ", " + pluralize(static_cast<std::uint64_t>(row.threads), "thread")}});
  }
  return table;
}

}  // namespace mssim
