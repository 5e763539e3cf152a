#include "bench/results/result.h"

#include <algorithm>
#include <cmath>

#include "integrators/all_integrators.h"
#include "statistics/statistics.h"

namespace mssim {

bool has_interval(std::size_t samples) { return rank_coverage(samples, 1) >= interval_confidence; }

std::string about_unchecked_samples(std::span<const ResultRow> rows) {
  const auto unchecked = std::ranges::count_if(
      rows, [](const ResultRow& row) { return counts(row) && has_unchecked_samples(row); });
  if (unchecked == 0) return "";
  return fmt::format(
      "the samples of {} are not checked, because the run was ended before that; bench --resume checks them",
      pluralize(unchecked, "row"));
}

void summarise(ResultRow& row, const ResultRow* serial) {
  row.rounds = static_cast<int>(row.samples_ms.size());
  if (row.status != "ok" || row.samples_ms.empty()) return;
  const MedianInterval time = median_interval(row.samples_ms);
  row.ms_per_step = time.median;
  row.ms_per_step_low = time.low;
  row.ms_per_step_high = time.high;
  row.ms_per_step_min = *std::min_element(row.samples_ms.begin(), row.samples_ms.end());
  const Integrator& integrator = *find_integrator(row.integrator);
  if (!is_implicit(integrator))
    row.springs_per_second = 1000 / time.median * static_cast<double>(row.springs_unique) *
                             static_cast<double>(integrator.stage_count);
  if (serial != nullptr && serial->samples_ms.size() == row.samples_ms.size())
    row.speedup_vs_serial = median_ratio(serial->samples_ms, row.samples_ms).median;
  const std::vector<Outlier> labels = outliers(row.samples_ms);
  row.outliers =
      static_cast<int>(labels.size() - static_cast<std::size_t>(std::ranges::count(labels, Outlier::no)));
}

void require_finite(ResultRow& row) {
  for (const ResultColumn& column : result_columns) {
    const auto* value = std::get_if<std::optional<double> ResultRow::*>(&column.value);
    if (!value || !(row.**value) || std::abs(*(row.**value)) <= largest_number) continue;
    const char* why = std::isfinite(*(row.**value)) ? "is beyond 1e300" : "is not finite";
    (row.**value).reset();
    row.verified = false;
    if (row.status == "ok") row.status = fmt::format("failed: {} {}", column.name, why);
  }
}

}  // namespace mssim
