#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <utility>
#include <vector>

#include "application/bench/ab_comparison.h"
#include "application/bench/bench_results.h"
#include "application/choices.h"
#include "application/console.h"
#include "bench/results/comparison.h"
#include "commands/command.h"
#include "commands/options.h"
#include "output/tables/results.h"
#include "platform/files.h"
#include "platform/machine.h"
#include "text/error.h"
#include "text/text.h"
#include "web/web.h"

namespace mssim {
namespace {

struct CompareOptions {
  AbOptions ab;  ///< for two folders: only base, next and threshold
  bool programs = false;
  double threshold_percent = 5;
  ComparisonFormat format = ComparisonFormat::table;
  std::string out;  ///< folder for the comparison; empty: none
  bool overwrite = false;
  bool force = false;
};

/// Times from different machines or builds show no regression or progress: reports the differences, and
/// refuses unless forced.
void require_comparable(const MeasuredRun& base, const MeasuredRun& next, bool force) {
  std::vector<std::string> all = differences(base.provenance, next.provenance);
  const std::vector<std::string> of_rows = differences(base.rows, next.rows);
  all.insert(all.end(), of_rows.begin(), of_rows.end());
  if (all.empty()) return;
  const std::string sentence = join(all, "; ");
  if (!force)
    throw UsageError("the two runs are not comparable: " + sentence +
                     "; measure both in the same way, or compare them anyway with --force");
  tell("compared anyway: {}", sentence);
}

/// Prints one line about combinations that are not in the table, however many.
void tell_left_out(const std::string& what, const std::vector<std::string>& combinations) {
  if (combinations.size() > 1)
    tell("{}: {} and {} more", what, combinations.front(), combinations.size() - 1);
  else if (!combinations.empty())
    tell("{}: {}", what, combinations.front());
}

/// Reasons for exit code 1: each combination that is slower or lost.
std::vector<std::string> regressions(const RunComparison& comparison) {
  std::vector<std::string> sentences;
  for (const ComparedRow& row : comparison.rows) {
    const std::string subject = fmt::format("{}: {}", combination_name(row), name_of(row.verdict));
    if (row.verdict == Verdict::slower)
      sentences.push_back(fmt::format("{}, {:.3g} times the time ({:.3g} to {:.3g})", subject,
                                      row.ratio->ratio, row.ratio->low, row.ratio->high));
    else if (row.verdict == Verdict::lost)
      sentences.push_back(subject + ", " + row.reason);
  }
  return sentences;
}

/// The files of --out, and how they hold the comparison.
constexpr auto files = std::to_array<std::pair<const char*, ComparisonFormat>>(
    {{"comparison.md", ComparisonFormat::markdown}, {"comparison.json", ComparisonFormat::json}});

int report(const RunComparison& comparison, const CompareOptions& options) {
  std::cout << to_text(comparison, options.format, terminal_of(STDOUT_FILENO).utf8);
  if (!options.out.empty()) {
    std::vector<FolderFile> written;
    for (const auto& [name, format] : files) written.push_back({name, to_text(comparison, format)});
    write_files_atomically(options.out, written);
  }
  tell_first(regressions(comparison));
  const auto undecided = std::ranges::count(comparison.rows, Verdict::undecided, &ComparedRow::verdict);
  if (undecided > 0)
    tell("{} of {} {} undecided", undecided, pluralize(comparison.rows.size(), "combination"),
         undecided == 1 ? "is" : "are");
  return has_regression(comparison) ? exit_regression : exit_ok;
}

int compare_runs(const CompareOptions& options) {
  const auto read = [](const std::string& path) {
    return is_web_results(path) ? read_web_results(path) : read_run(path);
  };
  const MeasuredRun base = read(options.ab.base), next = read(options.ab.next);
  require_comparable(base, next, options.force);
  tell_unchecked_samples(base.rows, options.ab.base);
  tell_unchecked_samples(next.rows, options.ab.next);
  const RunComparison comparison = compare(base.rows, next.rows, options.ab.threshold);
  tell_left_out("only BASE has", comparison.only_base);
  tell_left_out("only NEW has", comparison.only_new);
  tell_left_out("without a verified time in BASE", comparison.untimed);
  if (comparison.rows.empty() && !comparison.untimed.empty())
    throw UsageError(
        "there is nothing to compare: {} has no verified time of what both have; measure it again",
        options.ab.base);
  if (comparison.rows.empty())
    throw UsageError(
        "there is nothing to compare: " + options.ab.base + " and " + options.ab.next +
        " have no measured combination in common; measure the same scenes, backends and integrators");
  if (!options.out.empty()) make_folder(options.out);
  return report(comparison, options);
}

int run(CompareOptions options) {
  options.ab.threshold = options.threshold_percent / 100;
  if (!options.out.empty()) {  // finds what cannot be written before it measures
    for (const auto& [name, format] : files)
      require_free(std::filesystem::path(options.out) / name, "--out", options.overwrite);
    if (options.programs) make_folder(options.out);
  }
  if (!options.programs) return compare_runs(options);
  require_few_threads(options.ab.execution.threads);
  if (options.ab.scenes.empty()) throw UsageError("--ab needs a --scene to measure");
  StopRequest stop;
  const int code = report(compare_programs(options.ab), options);
  stop.throw_if_requested();
  return code;
}

}  // namespace

std::function<int()> declare_compare(Arguments& arguments) {
  const auto options = std::make_shared<CompareOptions>();
  arguments
      .add("BASE FOLDER|FILE", options->ab.base,
           "A folder that mssim bench --out wrote, a file in it, or one that the page of mssim web saved; "
           "with --ab an mssim program")
      .required();
  arguments.add("NEW FOLDER|FILE", options->ab.next, "Folder, file or program to compare with BASE")
      .required();
  arguments.add_number("--threshold PERCENT", options->threshold_percent,
                       "Smallest change that counts, in percent (default: 5)", positive_number());
  arguments.add_choice<ComparisonFormat>("--format", options->format,
                                         {{"table", ComparisonFormat::table},
                                          {"markdown", ComparisonFormat::markdown},
                                          {"json", ComparisonFormat::json}},
                                         "What to print: table, markdown or json (default: table)");
  const Argument out =
      arguments.add("--out DIR", options->out,
                    "Folder for the comparison as comparison.md and, with the samples, comparison.json");
  arguments.add_flag("--overwrite", options->overwrite, "Replace a comparison that the folder has")
      .needs(out);
  const Argument ab =
      arguments.add_flag("--ab", options->programs,
                         "BASE and NEW are mssim programs: run them alternately, as a new process each time");
  arguments
      .add_flag("--force", options->force,
                "Compare runs of different machines, builds, threads or scenes anyway")
      .excludes(ab);
  add_scenes(arguments, "--scene", options->ab.scenes, "With --ab: scenes to measure").needs(ab);
  options->ab.backends = {"openmp"};
  options->ab.integrators = {"semi-euler"};
  for (Argument argument : declare_backends_and_integrators(
           arguments, options->ab, "With --ab: backends, which may be programs of your own (default: openmp)",
           "With --ab: integrators (default: semi-euler)"))
    argument.needs(ab);
  arguments
      .add_number("--threads N", options->ab.execution.threads,
                  "With --ab: threads (default: one per available CPU)", whole_number(1, most_threads))
      .needs(ab);
  arguments
      .add_number("--time-budget SECONDS", options->ab.time_budget_s, "With --ab: time limit (default: 300)",
                  number_between(1, 86400))
      .needs(ab);
  return [options] { return run(*options); };
}

}  // namespace mssim
