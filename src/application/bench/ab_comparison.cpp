#include "application/bench/ab_comparison.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <random>
#include <thread>

#include "application/bench/bench_plan.h"
#include "application/console.h"
#include "backends/interface/backend.h"
#include "output/folders/result_folder.h"
#include "platform/machine.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;
/// The least of seven samples is hardly disturbed, even if other programs compete for every processor: with
/// eight of them on two processors, the ratio of two such samples varies by 0.1, that of medians by 0.5.
constexpr int samples_a_process = 7;

/// Limit of a verification, which may be slow on a busy machine, as a multiple of the time budget plus a
/// minute.
constexpr double verification_limit = 3;
/// Limit of samples, in times of a verification. They take less, or about as much if each process verifies
/// again.
constexpr double verifications_a_sample = 10;
/// Limit of printing a help page, which is fast.
constexpr double longest_help_s = 60, spare_help_s = 10;

unsigned whole_seconds(double seconds) { return static_cast<unsigned>(seconds + 0.5); }

/// One of the two programs, run repeatedly, each time as a new process. All member functions that run it
/// throw UsageError if it fails, Unavailable if it lacks a device, CsvError for results that cannot be read,
/// and Interrupted after the running process has been ended.
class AbProgram {
 public:
  /// Throws MissingProgram for a file that cannot be run.
  AbProgram(const std::string& file, const AbOptions& options) : file_(file), options_(options) {
    std::error_code error;
    if (!fs::is_regular_file(file, error) || ::access(file.c_str(), X_OK) != 0)
      throw MissingProgram("cannot run {}: give the path of an mssim program, such as ./mssim", file);
    child_.program = fs::absolute(file);
    child_.folder = fs::current_path();  // scenes may be files named from here
    limit(verification_limit * (options.time_budget_s + 60));
  }

  /// Whether its bench has the option --verified, according to its help. Throws UsageError if the help fails
  /// or does not end within a minute.
  bool takes_verified() const {
    ChildProcess child = child_;
    child.arguments = {"bench", "--help"};
    child.elapsed_seconds = whole_seconds(std::min(longest_help_s, options_.time_budget_s + spare_help_s));
    const ChildResult result = run(child);
    if (result.out_of_time)
      throw UsageError("{} bench --help has not ended within {} s: give the path of an mssim program", file_,
                       child.elapsed_seconds);
    if (result.signal != 0 || result.exit_code != exit_ok)
      throw UsageError("{} bench --help {}: give the path of an mssim program", file_, end_of(result));
    return result.output.find("--verified") != std::string::npos;
  }

  /// The process that verifies everything, on which later samples rely.
  ChildProcess verification() const {
    return bench_process(options_.backends, options_.integrators, 1, verified_folder());
  }
  /// Takes the result of the verification: the rows of a bench of one round.
  std::vector<CombinationTime> take_verification(const ChildResult& result) {
    verified_ = true;
    std::vector<CombinationTime> rows = rows_of(result, verified_folder());
    require_any_time(rows, result);
    return rows;
  }
  /// Extends the limit of samples to ten times that of the verification, if that is more.
  void allow(double verification_s) {
    limit(std::max<double>(child_.elapsed_seconds, verifications_a_sample * verification_s));
  }

  /// Samples these backends and integrators; verifies them again if no verification was taken. `first`:
  /// whether their status is still unknown.
  std::vector<CombinationTime> bench(const std::vector<std::string>& backends,
                                     const std::vector<std::string>& integrators, bool first) const {
    const TemporaryFolder folder;
    const fs::path out = folder.path() / "results";
    ChildProcess child = bench_process(backends, integrators, samples_a_process, out);
    if (verified_) add(child, "--verified", verified_folder().string());
    const ChildResult result = run(child);
    std::vector<CombinationTime> rows = rows_of(result, out);
    if (first) require_any_time(rows, result);
    return rows;
  }

 private:
  /// Bounds a program that would never end. Its processor time ends it if this process cannot any more.
  void limit(double seconds) {
    child_.elapsed_seconds = whole_seconds(seconds);
    child_.cpu_seconds = child_.elapsed_seconds * std::max(1U, std::thread::hardware_concurrency());
  }

  static void add(ChildProcess& child, const char* option, const std::string& value) {
    child.arguments.insert(child.arguments.end(), {option, value});
  }

  ChildProcess bench_process(const std::vector<std::string>& backends,
                             const std::vector<std::string>& integrators, int rounds,
                             const fs::path& out) const {
    ChildProcess child = child_;
    child.arguments = {"bench"};
    add(child, "--scene", join(options_.scenes, ","));
    add(child, "--backend", join(backends, ","));
    add(child, "--integrator", join(integrators, ","));
    add(child, "--rounds", std::to_string(rounds));
    add(child, "--out", out.string());
    const OwnBackendOptions& own = options_.own_backends;
    if (!own.folders.empty()) add(child, "--backend-folder", join(own.folders, ","));
    if (own.limit_s) add(child, "--backend-limit", decimal(*own.limit_s));
    const int threads = options_.execution.threads;
    if (threads > 0) add(child, "--threads", std::to_string(threads));
    return child;
  }

  std::vector<CombinationTime> rows_of(const ChildResult& result, const fs::path& out) const {
    // A bench ends with 1 for a row that is not verified and with 3 for one that cannot run; the row has the
    // details.
    const bool has_rows = !result.out_of_time && result.signal == 0 &&
                          (result.exit_code == exit_ok || result.exit_code == exit_not_verified ||
                           result.exit_code == exit_unavailable) &&
                          fs::exists(out / timings_name);
    if (!has_rows) fail(result);
    return read_combination_times(out / timings_name);
  }

  /// Throws Unavailable if no requested combination can run.
  void require_any_time(const std::vector<CombinationTime>& rows, const ChildResult& result) const {
    const auto is_timed = [](const CombinationTime& row) { return row.least_ms.has_value(); };
    if (result.exit_code == exit_unavailable && std::ranges::none_of(rows, is_timed)) fail(result);
  }

  fs::path verified_folder() const { return folder_.path() / "verified"; }

  static std::string end_of(const ChildResult& result) {
    return result.signal != 0 ? fmt::format("was ended by signal {}", result.signal)
                              : fmt::format("exited with {}", result.exit_code);
  }

  [[noreturn]] void fail(const ChildResult& result) const {
    std::cerr << result.output;
    if (!result.output.empty() && !result.output.ends_with('\n')) std::cerr << '\n';
    if (result.out_of_time)
      throw UsageError(
          "{} bench has not ended within {} s: run it alone to see why, or give a longer --time-budget",
          file_, child_.elapsed_seconds);
    const std::string sentence = file_ + " bench " + end_of(result) + " instead of measuring" +
                                 (result.output.empty() ? ", without a message" : "; its messages are above");
    if (result.signal == 0 && result.exit_code == exit_unavailable) throw Unavailable(sentence);
    throw UsageError(sentence);
  }

  std::string file_;
  const AbOptions& options_;
  ChildProcess child_;  ///< without arguments
  TemporaryFolder folder_;
  bool verified_ = false;
};

/// The combinations that both programs have. Those that only one has, or that have no time in BASE, are
/// reported and left out.
std::vector<PairedTimes> combinations_of(const std::vector<CombinationTime>& base,
                                         const std::vector<CombinationTime>& next, const AbOptions& options) {
  std::vector<PairedTimes> series;
  bool untimed = false;
  const auto tell_only = [](const std::string& program, const CombinationTime& time) {
    tell("only {} has {}", program, combination_name(time));
  };
  for (const CombinationTime& time : base) {
    if (!find_combination(next, time)) {
      tell_only(options.base, time);
    } else if (time.least_ms) {
      series.push_back({static_cast<const CombinationNames&>(time), {}, {}, {}});
    } else {
      untimed = true;
      tell("{} has no time for {}: {}", options.base, combination_name(time), time.status);
    }
  }
  for (const CombinationTime& time : next)
    if (!find_combination(base, time)) tell_only(options.next, time);
  if (series.empty() && untimed)
    throw UsageError(
        "there is nothing to compare: {} has no verified time of what both have; the reasons are above",
        options.base);
  if (series.empty())
    throw UsageError("there is nothing to compare: " + options.base + " and " + options.next +
                     " have no measured combination in common; choose other backends or integrators");
  return series;
}

/// Adds a round to a combination, or marks it as lost if it has no time in NEW; a time of BASE then shows
/// what it was. If BASE has no time for it any more, there is nothing to compare with: reports that and
/// returns false.
bool add_round(PairedTimes& pairs, const std::vector<CombinationTime>& base,
               const std::vector<CombinationTime>& next, const AbOptions& options) {
  const CombinationTime *a = find_combination(base, pairs), *b = find_combination(next, pairs);
  if (!a || !a->least_ms) {
    tell("{} had a time for {} but has none in a later round ({}); run it alone to see why", options.base,
         combination_name(pairs), a ? a->status : "the row is missing");
    return false;
  }
  if (!b || !b->least_ms) {
    if (pairs.base_ms.empty()) pairs.base_ms.push_back(*a->least_ms);
    pairs.lost = b ? b->status : "missing in a later round";
    return true;
  }
  pairs.base_ms.push_back(*a->least_ms);
  pairs.new_ms.push_back(*b->least_ms);
  return true;
}

/// The values of this member in the combinations that are not settled, each once.
std::vector<std::string> still_wanted(std::string PairedTimes::*member,
                                      const std::vector<PairedTimes>& series, const AbOptions& options) {
  std::vector<std::string> names;
  for (const PairedTimes& one : series)
    if (!is_settled(one, options.threshold)) add_once(names, one.*member);
  return names;
}

/// The requested backends whose rows are not settled.
std::vector<std::string> backends_wanted(const AbOptions& options, const std::vector<PairedTimes>& series) {
  const std::vector<std::string> rows = still_wanted(&PairedTimes::backend, series, options);
  std::vector<std::string> asked;
  for (const std::string& backend : options.backends)
    if (std::ranges::find(rows, row_name(backend)) != rows.end()) asked.push_back(backend);
  return asked;
}

/// Whether there is memory for a bench of both programs at the same time, with as much to spare. This is an
/// estimate: a compared program may have scenes or backends that this one does not know.
bool both_fit(const AbOptions& options) {
  BenchOptions bench;
  static_cast<AskedCombinations&>(bench) = static_cast<const AskedCombinations&>(options);
  bench.dry_run = true;
  try {
    return std::ranges::all_of(plan_of(bench).timed, [](const PlannedScene& scene) {
      return scene.memory_bytes <= available_memory() / 4;
    });
  } catch (const std::exception&) {
    return false;
  }
}

/// Verifies both programs once, if both can rely on it later, and returns the combinations. Otherwise every
/// process verifies again and the result is empty; the first round then finds the combinations.
std::vector<PairedTimes> verify(std::array<AbProgram, 2>& programs, const AbOptions& options,
                                ProgressLine& progress) {
  for (std::size_t which = 0; which < programs.size(); ++which)
    if (!programs[which].takes_verified()) {
      tell("{} has no bench --verified: each process of both programs verifies again, which takes time",
           which == 0 ? options.base : options.next);
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
  std::vector<PairedTimes> series = combinations_of(rows[0], rows[1], options);
  for (PairedTimes& one : series)  // without a time of BASE: both may have run at the same time
    if (const CombinationTime& next = *find_combination(rows[1], one); !next.least_ms) one.lost = next.status;
  return series;
}

}  // namespace

RunComparison compare_programs(const AbOptions& options) {
  std::array<AbProgram, 2> programs{AbProgram(options.base, options), AbProgram(options.next, options)};
  std::mt19937_64 random(std::random_device{}());
  std::vector<PairedTimes> series;
  const auto is_one_settled = [&](const PairedTimes& one) { return is_settled(one, options.threshold); };
  const auto settled = [&] { return !series.empty() && std::ranges::all_of(series, is_one_settled); };
  const Stopwatch watch;
  double longest_s = 0;
  std::size_t rounds = 0;
  {
    ProgressLine progress({1});
    progress.begin_scene(fmt::format("{} and {} alternately", options.base, options.next));
    series = verify(programs, options, progress);
    while (!settled() && (rounds == 0 || watch.seconds() + longest_s <= options.time_budget_s)) {
      const Stopwatch round_watch;
      const bool all = series.empty();
      std::array<std::vector<CombinationTime>, 2> times;
      const std::size_t first = random() & 1U;
      try {
        throw_if_ending_signal_noted();
        for (const std::size_t which : {first, 1 - first})
          times[which] = programs[which].bench(
              all ? options.backends : backends_wanted(options, series),
              all ? options.integrators : still_wanted(&PairedTimes::integrator, series, options), all);
      } catch (const Interrupted& interrupted) {
        if (rounds == 0) throw;
        note_ending_signal(interrupted.signal);
        break;
      }
      if (all) series = combinations_of(times[0], times[1], options);
      std::erase_if(series, [&](PairedTimes& one) {
        return !is_one_settled(one) && !add_round(one, times[0], times[1], options);
      });
      if (series.empty())
        throw UsageError("nothing is left to compare: {} has lost every combination; see the messages above",
                         options.base);
      ++rounds;
      longest_s = std::max(longest_s, round_watch.seconds());
      progress.update(fmt::format("round {}", rounds), watch.seconds() / options.time_budget_s);
    }
  }
  tell("{} in {} s{}", pluralize(rounds, "round"), std::lround(watch.seconds()),
       settled()               ? ""
       : noted_ending_signal() ? "; a signal ended it before every verdict was settled"
                               : "; the time budget ended before every verdict was settled");
  RunComparison comparison;
  comparison.threshold = options.threshold;
  for (const PairedTimes& one : series) comparison.rows.push_back(compare_pairs(one, options.threshold));
  add_means(comparison);
  return comparison;
}

}  // namespace mssim
