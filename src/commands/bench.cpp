#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "application/bench/bench_plan.h"
#include "application/bench/bench_results.h"
#include "application/bench/bench_run.h"
#include "application/bench/suites.h"
#include "application/console.h"
#include "application/guide_run.h"
#include "application/prepared_scene.h"
#include "commands/command.h"
#include "commands/options.h"
#include "mesh/meshing.h"
#include "output/tables/results.h"
#include "output/tables/suite_tables.h"
#include "output/tables/table.h"
#include "platform/machine.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// How a bench prints its rows: as a listing, or without a format as github_table().
using SummaryFormat = std::optional<ListingFormat>;

/// The requested bench, and how to print it.
struct BenchRequest : BenchOptions {
  SummaryFormat format = ListingFormat::table;
};

std::string text_of(const Table& table, SummaryFormat format) {
  return table.rows.empty() || !format ? "" : to_text(table, *format);
}

/// "opencl, hybrid ran on DEVICE", for each OpenCL device.
std::vector<std::string> devices_of(RowPointers rows) {
  std::map<std::string_view, std::vector<std::string>> backends;
  for (const ResultRow* row : rows) {
    const std::string_view device = opencl_device(*row);
    if (!device.empty()) add_once(backends[device], row->backend);
  }
  std::vector<std::string> sentences;
  for (const auto& [device, names] : backends)
    sentences.push_back(fmt::format("{} ran on {}", join(names, ", "), device_name(device)));
  return sentences;
}

/// Remarks to be printed after `table`, a row_table.
std::string remarks(RowPointers rows, std::string_view table, const Provenance& provenance,
                    std::optional<int> width) {
  std::vector<std::string> sentences = devices_of(rows);
  sentences.insert(sentences.end(), {legend_of_ratios(table), legend_of_excess(rows, provenance),
                                     reason_without_speedups(rows)});
  std::string text;
  for (const std::string& sentence : sentences)
    if (!sentence.empty())
      text += wrapped(sentence, width ? static_cast<std::size_t>(*width) : SIZE_MAX, "") + '\n';
  return text;
}

/// The rows for a reader, with the columns that answer "how fast, how right". A table (row_table) is laid out
/// for `terminal` and followed by remarks. `provenance` has the requested threads. Ends with a newline; empty
/// for a table without rows.
std::string summary(std::span<const ResultRow> rows, SummaryFormat format, const Provenance& provenance,
                    const Terminal& terminal) {
  if (!format) return to_text(github_table(rows), ListingFormat::json);
  const std::vector<const ResultRow*> pointers = pointers_to(rows);
  if (format != ListingFormat::table) return text_of(printed_table(pointers), format);
  const std::string text = row_table(pointers, provenance, terminal);
  return text + remarks(pointers, text, provenance, terminal.width);
}

/// Throws UsageError for a plan of two tables in a format of one, and for one without times in a format of
/// times.
void require_table_for(const BenchPlan& plan, SummaryFormat format, bool dry_run) {
  if (plan.timed.empty() && (!format || (dry_run && format != ListingFormat::table)))
    throw UsageError("{} is of scenes that are timed, and there are none: leave it out, or name a --scene",
                     dry_run ? "--format with --dry-run" : "--format github");
  if (!format || format == ListingFormat::table || plan.described.empty() || plan.timed.empty()) return;
  throw UsageError(
      "--format csv and json are of one table, and sizes and times are two: ask for --suite {} alone, and "
      "for the others without it",
      std::ranges::find(suites(), false, &Suite::timed)->name);
}

/// Prints the plan: what would be measured, and the expected time.
void tell_plan(const BenchPlan& plan, SummaryFormat format) {
  if (!format)
    throw UsageError("--format github is of times, which --dry-run does not measure: leave one of them out");
  const ExpectedTime all = total(times_of(plan.timed));
  const double rounds = expected_rounds(plan);
  const auto seconds = [&](const ExpectedTime& time) { return std::lround(std::ceil(time.with(rounds))); };
  Table table;
  for (const PlannedScene& scene : plan.timed)
    table.add({{"scene", scene.spec.name},
               {"nodes", scene.size.nodes},
               {"springs_unique", scene.size.springs},
               {"combinations", scene.backends.size() * plan.settings.integrators.size()},
               {"rounds", std::lround(rounds)},
               {"expected_s", seconds(scene.time)}});
  if (format != ListingFormat::table) {
    std::cout << to_text(table, *format);
    return;
  }
  for (const UnbuiltScene& scene : plan.described)
    std::cout << scene.spec.name << ": not timed; its structure is shown\n";
  std::cout << to_text(table);
  std::cout << "about " << seconds(all) << " s in all\n";
}

/// Printed before hours of measuring, not after.
void tell_before(const BenchPlan& plan) {
  if (plan.timed.empty()) return;
  for (const std::string& noise : plan.provenance.noise) tell("noise: {}", noise);
  if (plan.uses_device) tell_of_opencl();
  const auto backends = mapped<std::string_view>(plan.settings.backends, &BackendInfo::name);
  if (const std::string reason = reason_without_speedups(backends); !reason.empty()) tell(reason);
}

/// The structure of a scene of bodies. Throws std::invalid_argument for a scene without tetrahedra.
StructureRow structure_of(const PreparedScene& scene) {
  const auto* mesh = std::get_if<TetrahedralMesh>(&scene.system.topology);
  if (mesh == nullptr) throw std::invalid_argument(scene.spec.name + " has no tetrahedra");
  StructureRow row;
  row.scene = scene.spec.name;
  row.nodes = scene.counts.nodes;
  row.springs_unique = scene.counts.springs_unique;
  row.springs_published = scene.counts.springs_published.value();
  row.tetrahedra = mesh->tetrahedra.size();
  // At the start, a body is rotated and moved, but not deformed.
  row.smallest_dihedral_angle_deg = smallest_dihedral_angle({scene.system.start.position, mesh->tetrahedra});
  return row;
}

std::vector<StructureRow> describe_scenes(std::vector<UnbuiltScene>& scenes) {
  std::vector<StructureRow> rows;
  for (UnbuiltScene& unbuilt : scenes) {
    const PreparedScene scene = unbuilt.prepare();
    warn_of_note(scene);
    rows.push_back(structure_of(scene));
  }
  return rows;
}

void tell_where_results_are(const BenchPlan& plan, const BenchResults& results, bool stopped) {
  if (!results.folder()) return;
  const std::string folder = escaped(plan.output.folder);
  if (!stopped)
    tell("results are in {}", folder);
  else if (results.rows().empty() && results.folder()->has_results())
    tell("nothing was measured yet; earlier results are still in {}", folder);
  else if (results.rows().empty())
    tell("nothing was measured yet; --resume continues");
  else
    tell("results so far are in {}; --resume continues", folder);
}

/// Row names of the requested backends, including those given as a path.
std::vector<std::string> asked_backends(const BenchOptions& options, const BenchPlan& plan) {
  if (options.backends.empty()) return {};
  return mapped<std::string>(plan.settings.backends, &BackendInfo::name);
}

/// Runs the suite whose scenes are measured by guides, without samples of single steps.
int run_guide_suite(const BenchRequest& options) {
  const auto refuse = [&](bool given, const std::string& name) {
    if (given) throw UsageError("{} cannot be used with --suite {}: leave it out", name, options.suite);
  };
  refuse(options.output.resume, "--resume");
  refuse(options.output.trace, "--trace");
  refuse(options.rounds.has_value(), "--rounds");
  refuse(options.windows.has_value(), "--windows");
  refuse(options.fps.has_value(), "--fps");
  refuse(!options.verified.empty(), "--verified");
  refuse(options.threads.size() > 1, "a list of --threads");
  refuse(options.instruction_sets.size() > 1, "a list of --instruction-set");
  refuse(options.format != ListingFormat::table, "--format");
  GuideOptions guide;
  static_cast<AskedCombinations&>(guide) = static_cast<const AskedCombinations&>(options);
  guide.scenes = scenes_of_suite(options.suite, true);
  guide.scenes.insert(guide.scenes.end(), options.scenes.begin(), options.scenes.end());
  guide.time_budget_s = options.time_budget_s;
  guide.folder = options.output.folder;
  guide.overwrite = options.output.overwrite;
  guide.dry_run = options.dry_run;
  return run_guide(guide);
}

int run(const BenchRequest& options) {
  if (options.suite == guide_suite) return run_guide_suite(options);
  BenchPlan plan = plan_of(options);
  require_table_for(plan, options.format, options.dry_run);
  TimeBudget budget(plan.time_budget_s, times_of(plan.timed));
  if (options.dry_run) {
    tell_plan(plan, options.format);
    return exit_ok;
  }
  BenchResults results(plan);
  tell_before(plan);
  const SummaryFormat format = options.format;
  std::vector<StructureRow> structure;
  if (!plan.described.empty()) {
    structure = describe_scenes(plan.described);
    std::cout << text_of(structure_rows(structure), format);  // nothing in the format of times
  }
  int code = exit_ok;
  StopRequest stop;
  if (!plan.timed.empty()) {
    const std::vector<std::string> lost = measure_scenes(plan, budget, stop, results);
    if (!plan.described.empty() && format == ListingFormat::table) std::cout << '\n';
    std::cout << summary(results.rows(), format, plan.provenance, terminal_of(STDOUT_FILENO));
    if (!format && results.folder() && !results.rows().empty())
      results.folder()->write_for_github(results.rows());
    tell_unchecked_samples(results.rows(), "");
    const BenchVerdict verdict =
        verdict_of(results.rows(), asked_backends(options, plan), options.integrators);
    tell_first(verdict.reasons);
    tell_first(lost);
    code = verdict.exit_code == exit_ok && !lost.empty() ? exit_unavailable : verdict.exit_code;
  }
  // The first write replaces earlier results, so nothing is written before there is a row.
  if (results.folder() && !structure.empty() && (plan.timed.empty() || !results.rows().empty()))
    results.folder()->write(std::vector{structure_table(structure, plan.provenance)});
  tell_where_results_are(plan, results, stop.requested());
  stop.throw_if_requested();
  return code;
}

/// The default integrators, followed by those of suites with other defaults.
std::string default_integrators() {
  const auto named = [](std::span<const std::string_view> integrators) {
    return join(std::vector<std::string>(integrators.begin(), integrators.end()), ",");
  };
  const std::string usual = named(comparison_of_suite("").integrators);
  std::map<std::string, std::vector<std::string>> others;
  for (const Suite& suite : suites())
    if (const std::string own = named(suite.comparison.integrators); own != usual)
      others[own].emplace_back(suite.name);
  std::string text = usual;
  for (const auto& [own, names] : others) text += "; with --suite " + listed(names, "or") + ' ' + own;
  return text;
}

}  // namespace

std::function<int()> declare_bench(Arguments& arguments) {
  const auto options = std::make_shared<BenchRequest>();
  auto names = mapped<std::string>(suites(), &Suite::name);
  names.emplace_back("tables");
  add_scenes(arguments, "--scene", options->scenes,
             "Scenes to measure: names (see mssim list scenes) or files");
  arguments.add("--suite NAME", options->suite,
                "Scenes, and what to compare on them: " + listed(names, "or") +
                    " (see mssim list suites); tables stands for table1, table2 and table3",
                one_of("suite", names, {{"all", "tables"}}));
  declare_backends_and_integrators(
      arguments, *options,
      "Backends, or methods with --suite races (default: all of mssim's); NAME:each steps each body for "
      "itself, NAME:4 takes four threads, NAME:AVX2 that instruction set, serial:double and openmp:double "
      "that precision; a path with a slash, or a described name, is a program of your own",
      fmt::format("Integrators, or all (default: {})", default_integrators()));
  declare_execution(arguments, options->execution, &options->threads, &options->instruction_sets);
  arguments.add_number("--rounds N", options->rounds,
                       "Samples of each combination (default: 15); with --time-budget the largest number",
                       whole_number(1, most_rounds));
  arguments.add_number(
      "--time-budget SECONDS", options->time_budget_s,
      "Time limit for the measurement, which takes as many rounds as fit; traces take extra time",
      time_budget());
  arguments.add_number("--fps N", options->fps,
                       fmt::format("Also time {} single frames of 1/N s for each combination, after its "
                                   "samples (columns frame_...), which takes extra time",
                                   timed_frames),
                       positive_number());
  arguments.add_number(
      "--windows N", options->windows,
      "Verify cloths in N windows instead of as a whole; only for backends in ranks (default: --ranks + 8 "
      "windows if the whole cloth does not fit into memory)",
      whole_number(2, 100'000));
  arguments.add_flag("--new-references", options->new_references,
                     "Neither use double-precision references of earlier runs nor keep new ones");
  arguments.add_flag("--dry-run", options->dry_run,
                     "Print what would be measured and about how long it would take, then exit; counts all "
                     "rounds, also those that --resume would keep");
  arguments.add("--out FOLDER", options->output.folder,
                "Folder for the results: tables, samples, provenance");
  const Argument resume =
      arguments.add_flag("--resume", options->output.resume,
                         "Continue an interrupted run of the same command, keeping its finished rounds");
  arguments.add_flag("--overwrite", options->output.overwrite, "Replace existing results in the folder")
      .excludes(resume);
  arguments.add_flag(
      "--trace", options->output.trace,
      "Also trace each combination into FOLDER/traces, after it has been timed (not of garments)");
  arguments.add_choice<SummaryFormat>(
      "--format", options->format,
      {{"table", ListingFormat::table},
       {"csv", ListingFormat::csv},
       {"json", ListingFormat::json},
       {"github", std::nullopt}},
      "What to print: table, csv, json, or github (the input of github-action-benchmark, "
      "also written into FOLDER) (default: table)");
  arguments.add(
      "--verified FOLDER", options->verified,
      "Result folder of an earlier run of this program that verified these combinations; only samples "
      "are taken");
  return [options] {
    if (!options->threads.empty()) options->execution.threads = std::ranges::max(options->threads);
    if (!options->instruction_sets.empty())
      options->execution.instruction_set = options->instruction_sets.front();
    return run(*options);
  };
}

}  // namespace mssim
