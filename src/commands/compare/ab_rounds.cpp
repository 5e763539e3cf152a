#include "commands/compare/ab_rounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <random>

#include "bench/results/comparison.h"
#include "commands/bench/bench_plan.h"
#include "commands/compare/ab_program.h"
#include "commands/shared/progress_line.h"
#include "output/tables/combination_times.h"
#include "platform/machine.h"
#include "platform/process.h"
#include "text/error.h"

namespace mssim {
namespace {

/// A combination under way. Its pairs grow until they are settled.
struct Series {
  PairedTimes pairs;
  bool settled = false;
};

const CombinationTime* find(const std::vector<CombinationTime>& times, const PairedTimes& pairs) {
  const auto found =
      std::ranges::find_if(times, [&](const CombinationTime& time) { return same_combination(time, pairs); });
  return found == times.end() ? nullptr : &*found;
}

/// The combinations that both programs have; what only one has, or BASE has no time of, is told and left out.
std::vector<Series> combinations_of(const std::vector<CombinationTime>& base,
                                    const std::vector<CombinationTime>& next, const AbOptions& options) {
  std::vector<Series> series;
  for (const CombinationTime& time : base) {
    const PairedTimes pairs{time.scene, time.backend, time.integrator, {}, {}, {}};
    if (!find(next, pairs))
      std::cerr << "mssim: only " << options.base << " has " << combination_name(time) << '\n';
    else if (!time.least_ms)
      std::cerr << "mssim: " << options.base << " has no time of " << combination_name(time) << ": "
                << time.status << '\n';
    else
      series.push_back({pairs});
  }
  if (series.empty())
    throw UsageError("there is nothing to compare: " + options.base + " and " + options.next +
                     " have no measured combination in common; choose other backends or integrators");
  return series;
}

/// A combination that NEW has no time of is lost; the one that BASE had shows what there was.
void lose(Series& series, const CombinationTime& base, const std::string& why) {
  if (series.pairs.base_ms.empty()) series.pairs.base_ms.push_back(*base.least_ms);
  series.pairs.lost = why;
  series.settled = true;
}

/// Adds a round to a combination.
void add_round(Series& series, const std::vector<CombinationTime>& base,
               const std::vector<CombinationTime>& next, double threshold) {
  PairedTimes& pairs = series.pairs;
  const CombinationTime *a = find(base, pairs), *b = find(next, pairs);
  if (!a || !b)
    throw UsageError(
        combination_name(pairs) +
        " was measured in one round and is missing in another; run each program separately to see why");
  if (!a->least_ms)
    throw UsageError(combination_name(pairs) + " was measured in one round and not in another (" + a->status +
                     "); run each program separately to see why");
  if (!b->least_ms) return lose(series, *a, b->status);
  pairs.base_ms.push_back(*a->least_ms);
  pairs.new_ms.push_back(*b->least_ms);
  series.settled = is_settled(pairs, threshold);
}

/// What the combinations that are not settled have as this member, each name once.
std::vector<std::string> still_wanted(std::string PairedTimes::*member, const std::vector<Series>& series) {
  std::vector<std::string> names;
  for (const Series& one : series)
    if (!one.settled && std::ranges::find(names, one.pairs.*member) == names.end())
      names.push_back(one.pairs.*member);
  return names;
}

/// Those of the backends that were asked for whose rows are still wanted.
std::vector<std::string> backends_wanted(const AbOptions& options, const std::vector<Series>& series) {
  const std::vector<std::string> rows = still_wanted(&PairedTimes::backend, series);
  std::vector<std::string> asked;
  for (const std::string& backend : options.backends)
    if (std::ranges::find(rows, row_name(backend)) != rows.end()) asked.push_back(backend);
  return asked;
}

/// Whether the memory does for a bench of either at the same time, with as much again to spare, as far as
/// this program can tell: one that is compared may have scenes or backends that this one does not know.
bool both_fit(const AbOptions& options) {
  BenchOptions bench;
  bench.scenes = options.scenes;
  bench.backends = options.backends;
  bench.own_backends = options.own_backends;
  bench.integrators = options.integrators;
  bench.execution.threads = options.threads;
  bench.dry_run = true;
  try {
    return std::ranges::all_of(plan_of(bench).timed, [](const PlannedScene& scene) {
      return scene.memory_bytes <= available_memory() / 4;
    });
  } catch (const std::exception&) {
    return false;
  }
}

/// Verifies both programs once, where both can rely on it afterwards, and says which combinations there are.
/// Otherwise every process of either verifies again, and the first round will say it: none.
std::vector<Series> verify(std::array<AbProgram, 2>& programs, const AbOptions& options,
                           ProgressLine& progress) {
  for (std::size_t which = 0; which < programs.size(); ++which)
    if (!programs[which].takes_verified()) {
      std::cerr
          << "mssim: " << (which == 0 ? options.base : options.next)
          << " has no bench --verified: each process of both programs verifies again, which takes time\n";
      return {};
    }
  progress.update("verify both", 0);
  const Stopwatch watch;
  const std::array processes{programs[0].verification(), programs[1].verification()};
  // Nothing is timed, and the reference takes one processor.
  const std::vector<ChildResult> results =
      both_fit(options) ? run_together(processes) : std::vector{run(processes[0]), run(processes[1])};
  const std::array rows{programs[0].take_verification(results[0]), programs[1].take_verification(results[1])};
  for (AbProgram& program : programs) program.allow(watch.seconds());
  std::vector<Series> series = combinations_of(rows[0], rows[1], options);
  for (Series& one : series)
    if (const CombinationTime& next = *find(rows[1], one.pairs); !next.least_ms)
      lose(one, *find(rows[0], one.pairs), next.status);
  return series;
}

}  // namespace

RunComparison compare_programs(const AbOptions& options) {
  std::array<AbProgram, 2> programs{AbProgram(options.base, options), AbProgram(options.next, options)};
  std::mt19937_64 random(std::random_device{}());
  std::vector<Series> series;
  const auto settled = [&] { return !series.empty() && std::ranges::all_of(series, &Series::settled); };
  const Stopwatch watch;
  double longest_s = 0;
  std::size_t rounds = 0;
  {
    ProgressLine progress({1});
    progress.begin_scene(options.base + " and " + options.next + " alternately");
    series = verify(programs, options, progress);
    while (!settled() && (rounds == 0 || watch.seconds() + longest_s <= options.time_budget_s)) {
      const Stopwatch round_watch;
      const bool all = series.empty();
      std::array<std::vector<CombinationTime>, 2> times;
      const std::size_t first = random() & 1U;
      for (const std::size_t which : {first, 1 - first})
        times[which] =
            programs[which].bench(all ? options.backends : backends_wanted(options, series),
                                  all ? options.integrators : still_wanted(&PairedTimes::integrator, series));
      if (all) series = combinations_of(times[0], times[1], options);
      for (Series& one : series)
        if (!one.settled) add_round(one, times[0], times[1], options.threshold);
      ++rounds;
      longest_s = std::max(longest_s, round_watch.seconds());
      progress.update("round " + std::to_string(rounds), watch.seconds() / options.time_budget_s);
    }
  }
  std::cerr << "mssim: " << rounds << (rounds == 1 ? " round in " : " rounds in ")
            << std::lround(watch.seconds()) << " s"
            << (settled() ? "" : "; the time budget ended before every verdict was settled") << '\n';
  RunComparison comparison;
  comparison.threshold = options.threshold;
  for (const Series& one : series) comparison.rows.push_back(compare_pairs(one.pairs, options.threshold));
  add_means(comparison);
  return comparison;
}

}  // namespace mssim
