#include "output/tables/github_table.h"

#include <string>

#include "output/tables/table.h"
#include "text/text.h"

namespace mssim {

Table github_table(std::span<const ResultRow> rows) {
  const auto text = [](const std::optional<double>& ms) { return ms ? csv_number(*ms) : std::string(); };
  Table table;
  for (const ResultRow& row : rows) {
    if (row.status != "ok" || !row.ms_per_step) continue;
    table.add({{"name", row.scene + '/' + row.backend + '/' + row.integrator},
               {"unit", "ms/step"},
               {"value", *row.ms_per_step},
               {"range", text(row.ms_per_step_low) + " to " + text(row.ms_per_step_high)},
               {"extra", row.device + ", " + pluralize(static_cast<std::uint64_t>(row.threads), "thread")}});
  }
  return table;
}

}  // namespace mssim
