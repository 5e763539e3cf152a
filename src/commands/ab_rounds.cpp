#include "commands/ab_rounds.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <random>
#include <thread>

#include "backends/backend.h"
#include "bench/paired_times.h"
#include "commands/exit_code.h"
#include "commands/progress_line.h"
#include "mesh/child_process.h"
#include "mesh/mesh_error.h"
#include "mesh/temporary_folder.h"
#include "model/joined.h"
#include "output/combination_times.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// The least of so many is hardly disturbed, even where other programs want every processor, too: with eight
/// of them on two processors the ratio of two such spreads by 0.1, that of medians by 0.5.
constexpr int samples_a_process = 7;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One of the two, ready to be run again and again.
class Program {
 public:
  Program(const std::string& file, const AbOptions& options) : file_(file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error) || ::access(file.c_str(), X_OK) != 0)
      throw MissingProgram("cannot run " + file + ": give the path of an mssim program");
    child_.program = fs::absolute(file);
    child_.folder = fs::current_path();  // scenes may be files named from here
    child_.arguments = {"bench",
                        "--scene",
                        joined(options.scenes, ","),
                        "--backend",
                        joined(options.backends, ","),
                        "--integrator",
                        joined(options.integrators, ","),
                        "--rounds",
                        std::to_string(samples_a_process)};
    if (options.threads > 0) {
      child_.arguments.emplace_back("--threads");
      child_.arguments.push_back(std::to_string(options.threads));
    }
    // One that never ends shall not run for ever.
    child_.cpu_seconds =
        static_cast<unsigned>(options.time_budget_s + 60) * std::max(1U, std::thread::hardware_concurrency());
  }

  /// One short bench in a process of its own.
  std::vector<CombinationTime> bench() const {
    const TemporaryFolder folder;
    ChildProcess child = child_;
    child.arguments.emplace_back("--out");
    child.arguments.push_back((folder.path() / "results").string());
    const ChildResult result = run(child);
    const fs::path timings = folder.path() / "results" / "timings.csv";
    // A row that is not verified ends a bench with 1; the row says so itself.
    const bool measured =
        result.signal == 0 && (result.exit_code == exit_ok || result.exit_code == exit_not_verified);
    if (!measured || !fs::exists(timings)) fail(result);
    return read_combination_times(timings);
  }

 private:
  [[noreturn]] void fail(const ChildResult& result) const {
    std::cerr << result.output;
    if (!result.output.empty() && !result.output.ends_with('\n')) std::cerr << '\n';
    const std::string how = result.signal != 0 ? "was ended by signal " + std::to_string(result.signal)
                                               : "exited with " + std::to_string(result.exit_code);
    const std::string sentence = file_ + " bench " + how + " instead of measuring" +
                                 (result.output.empty() ? ", saying nothing" : "; what it said stands above");
    if (result.signal == 0 && result.exit_code == exit_unavailable) throw Unavailable(sentence);
    throw UsageError(sentence);
  }

  std::string file_;
  ChildProcess child_;
};

/// The combinations of the first round; what only one program has is told and left out.
std::vector<PairedTimes> combinations_of(const std::vector<CombinationTime>& base,
                                         const std::vector<CombinationTime>& next, const AbOptions& options) {
  std::vector<PairedTimes> series;
  for (const CombinationTime& time : base) {
    const bool both = std::ranges::any_of(
        next, [&](const CombinationTime& other) { return same_combination(other, time); });
    const std::string name = combination_name(time);
    if (!both)
      std::cerr << "mssim: only " << options.base << " has " << name << '\n';
    else if (!time.least_ms)
      std::cerr << "mssim: " << options.base << " has no time of " << name << ": " << time.status << '\n';
    else
      series.push_back({time.scene, time.backend, time.integrator, {}, {}, {}});
  }
  if (series.empty())
    throw UsageError("there is nothing to compare: " + options.base + " and " + options.next +
                     " have no measured combination in common; choose other backends or integrators");
  return series;
}

/// Adds a round to each combination.
void add_round(std::vector<PairedTimes>& series, const std::vector<CombinationTime>& base,
               const std::vector<CombinationTime>& next) {
  for (PairedTimes& pairs : series) {
    const auto find = [&](const std::vector<CombinationTime>& times) -> const CombinationTime& {
      const auto found = std::ranges::find_if(
          times, [&](const CombinationTime& time) { return same_combination(time, pairs); });
      if (found == times.end())
        throw UsageError(
            combination_name(pairs) +
            " was measured in one round and is missing in another; run the programs by themselves");
      return *found;
    };
    const CombinationTime &a = find(base), &b = find(next);
    if (!a.least_ms)
      throw UsageError(combination_name(pairs) + " was measured in one round and not in another (" +
                       a.status + "); run the programs by themselves");
    pairs.base_ms.push_back(*a.least_ms);
    if (b.least_ms)
      pairs.new_ms.push_back(*b.least_ms);
    else
      pairs.lost = b.status;
    if (!pairs.lost.empty()) pairs.new_ms.resize(pairs.base_ms.size());  // no longer looked at
  }
}

}  // namespace

RunComparison compare_programs(const AbOptions& options) {
  const std::array<Program, 2> programs{Program(options.base, options), Program(options.next, options)};
  std::mt19937_64 random(std::random_device{}());
  std::vector<PairedTimes> series;
  const auto settled = [&] {
    return !series.empty() && std::ranges::all_of(series, [&](const PairedTimes& times) {
      return is_settled(times, options.threshold);
    });
  };
  const auto start = std::chrono::steady_clock::now();
  double longest_s = 0;
  std::size_t rounds = 0;
  {
    ProgressLine progress(1);
    progress.begin_scene(options.base + " and " + options.next + " by turns");
    while (!settled() && (rounds == 0 || seconds_since(start) + longest_s <= options.time_budget_s)) {
      const auto round_start = std::chrono::steady_clock::now();
      std::array<std::vector<CombinationTime>, 2> times;
      const std::size_t first = random() & 1U;
      for (const std::size_t which : {first, 1 - first}) times[which] = programs[which].bench();
      if (series.empty()) series = combinations_of(times[0], times[1], options);
      add_round(series, times[0], times[1]);
      ++rounds;
      longest_s = std::max(longest_s, seconds_since(round_start));
      progress.update("round " + std::to_string(rounds), seconds_since(start) / options.time_budget_s);
    }
  }
  std::cerr << "mssim: " << rounds << (rounds == 1 ? " round in " : " rounds in ")
            << std::lround(seconds_since(start)) << " s"
            << (settled() ? "" : "; the time budget ended before every interval was narrow enough") << '\n';
  RunComparison comparison;
  comparison.threshold = options.threshold;
  for (const PairedTimes& times : series) comparison.rows.push_back(compare_pairs(times, options.threshold));
  add_means(comparison);
  return comparison;
}

}  // namespace mssim
