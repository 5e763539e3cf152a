#include "output/tables/combination_times.h"

#include "output/tables/table.h"

namespace mssim {

std::vector<CombinationTime> read_combination_times(const std::filesystem::path& file) {
  const CsvTable table(file);
  const std::size_t scene = table.column("scene"), backend = table.column("backend"),
                    integrator = table.column("integrator"), ms = table.column("ms_per_step_min"),
                    verified = table.column("verified"), status = table.column("status");
  std::vector<CombinationTime> times;
  for (std::size_t row = 0; row < table.size(); ++row) {
    CombinationTime time{table.text(row, scene),
                         table.text(row, backend),
                         table.text(row, integrator),
                         {},
                         table.text(row, status)};
    if (time.status == "ok" && table.text(row, verified) != "true") time.status = "failed: not verified";
    if (time.status == "ok") {
      time.least_ms = table.number(row, ms);
      if (!(*time.least_ms > 0)) throw table.complaint(row, ms, "is not a time above zero");
    }
    times.push_back(std::move(time));
  }
  return times;
}

}  // namespace mssim
