#include "bench/results/paired_times.h"

#include "statistics/statistics.h"

namespace mssim {

namespace {

RatioEstimate ratio_at_look(const PairedTimes& times) {
  return paired_ratio(times.base_ms, times.new_ms, look_at(times.base_ms.size()).fraction);
}

}  // namespace

bool is_settled(const PairedTimes& times, double threshold) {
  if (!times.lost.empty()) return true;
  if (times.base_ms.size() != look_at(times.base_ms.size()).pairs) return false;
  return is_certain(ratio_at_look(times), threshold);
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
  row.ratio = ratio_at_look(times);
  if (times.base_ms.size() >= first_look_pairs) row.verdict = verdict_of(*row.ratio, threshold);
  if (row.verdict == Verdict::undecided)
    if (const auto needed = samples_needed(*row.ratio, times.base_ms.size(), threshold))
      row.samples_needed = look_at(*needed).pairs;
  return row;
}

}  // namespace mssim
