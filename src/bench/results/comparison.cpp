#include "bench/results/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "text/text.h"

namespace mssim {
namespace {

/// Adds "WHAT was BEFORE and is NOW" if they differ, each sentence once.
void add(std::vector<std::string>& sentences, const std::string& what, const std::string& before,
         const std::string& now) {
  if (before != now) add_once(sentences, fmt::format("{} was {} and is {}", what, before, now));
}

/// Results of an mssim that did not know generations can be compared without them.
std::string cpu_of(const Machine& machine, bool with_generation) {
  return fmt::format("{} with {} logical CPUs", with_generation ? cpu_name(machine) : machine.cpu_model,
                     machine.logical_cpus);
}

std::string size_of(const ResultRow& row) {
  return fmt::format("one of {} nodes and {} springs", row.nodes, row.springs_unique);
}

/// With fewer samples per side, even times that do not overlap are not significantly different.
constexpr std::size_t fewest_samples = 5;

/// A combination and its time in BASE.
ComparedRow row_of(const CombinationNames& combination, const std::vector<double>& base_ms) {
  ComparedRow row;
  static_cast<CombinationNames&>(row) = combination;
  if (!base_ms.empty()) row.base_ms = median(base_ms);
  row.base_samples_ms = base_ms;
  return row;
}

ComparedRow lost(ComparedRow row, const std::string& reason) {
  row.verdict = Verdict::lost;
  row.reason = reason;
  return row;
}

ComparedRow compare_rows(const ResultRow& base, const ResultRow& next, double threshold) {
  ComparedRow row = row_of(base, base.samples_ms);
  if (!counts(next)) return lost(std::move(row), status_of(next));
  row.new_ms = median(next.samples_ms);
  row.new_samples_ms = next.samples_ms;
  row.ratio = ratio_of(base.samples_ms, next.samples_ms);
  row.verdict = verdict_of(*row.ratio, threshold);
  if (row.verdict == Verdict::undecided)
    row.samples_needed =
        row.ratio->covers
            ? samples_needed(*row.ratio, std::min(base.samples_ms.size(), next.samples_ms.size()), threshold)
            : fewest_samples;
  return row;
}

RatioEstimate ratio_at_look(const PairedTimes& times) {
  return paired_ratio(times.base_ms, times.new_ms, look_at(times.base_ms.size()).fraction);
}

}  // namespace

std::vector<std::string> differences(const Provenance& before, const Provenance& now) {
  std::vector<std::string> sentences;
  const bool generations = !before.machine.cpu_generation.empty() && !now.machine.cpu_generation.empty();
  add(sentences, "the CPU", cpu_of(before.machine, generations), cpu_of(now.machine, generations));
  add(sentences, "the compiler", before.build.compiler, now.build.compiler);
  add(sentences, "the build type", before.build.build_type, now.build.build_type);
  add(sentences, "the list of compiler flags", '"' + before.build.flags + '"', '"' + now.build.flags + '"');
  add(sentences, "the number of threads", std::to_string(before.threads), std::to_string(now.threads));
  for (const SceneHash& scene : before.scenes)
    if (const SceneHash* same = found_in(now.scenes, scene.name, &SceneHash::name)) {
      add(sentences, "the hash of scene " + scene.name, to_hex(scene.fnv1a_64), to_hex(same->fnv1a_64));
      if (scene.files_fnv1a_64 && same->files_fnv1a_64)  // earlier programs did not record it
        add(sentences, "the hash of the files of scene " + scene.name, to_hex(*scene.files_fnv1a_64),
            to_hex(*same->files_fnv1a_64));
    }
  return sentences;
}

std::vector<std::string> differences(std::span<const ResultRow> before, std::span<const ResultRow> now) {
  std::vector<std::string> sentences;
  for (const ResultRow& row : before) {
    const ResultRow* same = find_combination(now, row);
    if (!same || !row.ms_per_step || !same->ms_per_step) continue;
    add(sentences, "the device of " + row.backend, row.device, same->device);
    add(sentences, "the number of threads of " + row.backend, std::to_string(row.threads),
        std::to_string(same->threads));
    add(sentences, "scene " + row.scene, size_of(row), size_of(*same));
  }
  return sentences;
}

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
  // Within the margin the interval must end before it. Beyond the margin it must keep away from 1 so far that
  // the difference is significant; that takes 2.58 deviations where the interval has 1.96.
  const double wanted = change < margin ? margin - change : change * 1.96 / 2.58;
  const double needed = std::ceil(static_cast<double>(samples) * std::pow(half_width / wanted, 2));
  if (!(needed <= static_cast<double>(most_samples_asked))) return std::nullopt;
  return std::max({static_cast<std::size_t>(needed), samples + 1, fewest_samples});
}

RunComparison compare(std::span<const ResultRow> base, std::span<const ResultRow> next, double threshold) {
  RunComparison comparison;
  comparison.threshold = threshold;
  for (const ResultRow& row : base) {
    const ResultRow* same = find_combination(next, row);
    if (!same)
      comparison.only_base.push_back(combination_name(row));
    else if (!counts(row))
      comparison.untimed.push_back(combination_name(row));
    else
      comparison.rows.push_back(compare_rows(row, *same, threshold));
  }
  for (const ResultRow& row : next)
    if (!find_combination(base, row)) comparison.only_new.push_back(combination_name(row));
  add_means(comparison);
  return comparison;
}

void add_means(RunComparison& comparison) {
  std::vector<std::string> names{""};
  for (const ComparedRow& row : comparison.rows) add_once(names, row.backend);
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

bool is_settled(const PairedTimes& times, double threshold) {
  if (!times.lost.empty()) return true;
  if (times.base_ms.size() != look_at(times.base_ms.size()).pairs) return false;
  return is_certain(ratio_at_look(times), threshold);
}

ComparedRow compare_pairs(const PairedTimes& times, double threshold) {
  ComparedRow row = row_of(times, times.base_ms);
  if (!times.lost.empty()) return lost(std::move(row), times.lost);
  row.new_ms = median(times.new_ms);
  row.new_samples_ms = times.new_ms;
  row.ratio = ratio_at_look(times);
  if (times.base_ms.size() >= first_look_pairs) row.verdict = verdict_of(*row.ratio, threshold);
  if (row.verdict == Verdict::undecided && !row.ratio->covers)
    row.samples_needed = first_look_pairs;
  else if (row.verdict == Verdict::undecided)
    if (const auto needed = samples_needed(*row.ratio, times.base_ms.size(), threshold))
      row.samples_needed = look_at(*needed).pairs;
  return row;
}

}  // namespace mssim
