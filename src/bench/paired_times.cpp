#include "bench/paired_times.h"

#include <algorithm>

#include "bench/statistics.h"

namespace mssim {

bool is_settled(const PairedTimes& times, double threshold) {
  if (!times.lost.empty()) return true;
  if (times.base_ms.size() < fewest_pairs) return false;
  const RatioEstimate ratio = paired_ratio(times.base_ms, times.new_ms);
  return ratio.high / ratio.low < 1 + threshold;
}

ComparedRow compare_pairs(const PairedTimes& times, double threshold) {
  ComparedRow row;
  row.scene = times.scene;
  row.backend = times.backend;
  row.integrator = times.integrator;
  row.base_ms = median(times.base_ms);
  if (!times.lost.empty()) {
    row.verdict = Verdict::lost;
    row.reason = times.lost;
    return row;
  }
  row.new_ms = median(times.new_ms);
  row.ratio = paired_ratio(times.base_ms, times.new_ms);
  if (times.base_ms.size() >= fewest_pairs) row.verdict = verdict_of(*row.ratio, threshold);
  if (row.verdict == Verdict::undecided)
    if (const auto needed = samples_needed(*row.ratio, times.base_ms.size(), threshold))
      row.samples_needed = std::max(*needed, fewest_pairs);
  return row;
}

}  // namespace mssim
