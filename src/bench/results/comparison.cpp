#include "bench/results/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "statistics/statistics.h"

namespace mssim {
namespace {

/// With so few samples a side even times that do not overlap are not significant.
constexpr std::size_t fewest_samples = 5;

const ResultRow* find(std::span<const ResultRow> rows, const ResultRow& row) {
  const auto same = std::ranges::find_if(
      rows, [&](const ResultRow& candidate) { return same_combination(candidate, row); });
  return same == rows.end() ? nullptr : &*same;
}

ComparedRow compare_rows(const ResultRow& base, const ResultRow& next, double threshold) {
  ComparedRow row;
  row.scene = base.scene;
  row.backend = base.backend;
  row.integrator = base.integrator;
  row.base_ms = median(base.samples_ms);
  if (!counts(next)) {
    row.verdict = Verdict::lost;
    row.reason = status_of(next);
    return row;
  }
  row.new_ms = median(next.samples_ms);
  row.ratio = ratio_of(base.samples_ms, next.samples_ms);
  row.verdict = verdict_of(*row.ratio, threshold);
  if (row.verdict == Verdict::undecided)
    row.samples_needed =
        samples_needed(*row.ratio, std::min(base.samples_ms.size(), next.samples_ms.size()), threshold);
  return row;
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  constexpr std::array<std::string_view, 5> names{"same", "faster", "slower", "undecided", "lost"};
  return names[static_cast<std::size_t>(verdict)];
}

Verdict verdict_of(const RatioEstimate& ratio, double threshold) {
  const double beyond = 1 + threshold;
  const bool significant = ratio.p < significance;
  if (significant && ratio.ratio > beyond) return Verdict::slower;
  if (significant && ratio.ratio < 1 / beyond) return Verdict::faster;
  if (ratio.covers && ratio.low >= 1 / beyond && ratio.high <= beyond) return Verdict::same;
  return Verdict::undecided;
}

bool is_certain(const RatioEstimate& ratio, double threshold) {
  const Verdict verdict = verdict_of(ratio, threshold);
  if (verdict == Verdict::same || verdict == Verdict::undecided) return verdict == Verdict::same;
  return ratio.covers && (ratio.low > 1 + threshold || ratio.high < 1 / (1 + threshold));
}

std::optional<std::size_t> samples_needed(const RatioEstimate& ratio, std::size_t samples, double threshold) {
  const double change = std::abs(std::log(ratio.ratio)), margin = std::log(1 + threshold);
  const double half_width = (std::log(ratio.high) - std::log(ratio.low)) / 2;
  // Within the margin the interval has to end before it; beyond, it has to keep so far from 1 that the
  // difference is significant, for which 2.58 deviations are asked where the interval has 1.96.
  const double wanted = change < margin ? margin - change : change * 1.96 / 2.58;
  const double needed = std::ceil(static_cast<double>(samples) * std::pow(half_width / wanted, 2));
  if (!(needed <= static_cast<double>(most_samples_asked))) return std::nullopt;
  return std::max({static_cast<std::size_t>(needed), samples + 1, fewest_samples});
}

RunComparison compare(std::span<const ResultRow> base, std::span<const ResultRow> next, double threshold) {
  RunComparison comparison;
  comparison.threshold = threshold;
  for (const ResultRow& row : base) {
    const ResultRow* same = find(next, row);
    if (!same)
      comparison.only_base.push_back(combination_name(row));
    else if (!counts(row))
      comparison.untimed.push_back(combination_name(row));
    else
      comparison.rows.push_back(compare_rows(row, *same, threshold));
  }
  for (const ResultRow& row : next)
    if (!find(base, row)) comparison.only_new.push_back(combination_name(row));
  add_means(comparison);
  return comparison;
}

void add_means(RunComparison& comparison) {
  std::vector<std::string> names{""};
  for (const ComparedRow& row : comparison.rows)
    if (std::ranges::find(names, row.backend) == names.end()) names.push_back(row.backend);
  for (const std::string& name : names) {
    std::vector<double> ratios;
    for (const ComparedRow& row : comparison.rows)
      if (row.ratio && (name.empty() || row.backend == name)) ratios.push_back(row.ratio->ratio);
    if (!ratios.empty()) comparison.means.push_back({name, ratios.size(), geometric_mean(ratios)});
  }
}

bool has_regression(const RunComparison& comparison) {
  return std::ranges::any_of(comparison.rows, [](const ComparedRow& row) {
    return row.verdict == Verdict::slower || row.verdict == Verdict::lost;
  });
}

}  // namespace mssim
