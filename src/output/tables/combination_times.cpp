#include "output/tables/combination_times.h"

#include <algorithm>

#include "output/tables/csv.h"

namespace mssim {

std::vector<CombinationTime> read_combination_times(const std::filesystem::path& file) {
  const CsvTable table(file);
  const auto column = [&](const std::string& name) {
    const auto found = std::ranges::find(table.header(), name);
    if (found == table.header().end())
      throw CsvError(file.string() + ", line 1: there is no column " + name +
                     "; use a program that writes it");
    return static_cast<std::size_t>(found - table.header().begin());
  };
  const std::size_t scene = column("scene"), backend = column("backend"), integrator = column("integrator"),
                    ms = column("ms_per_step_min"), verified = column("verified"), status = column("status");
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
