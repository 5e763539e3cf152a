#include "commands/bench/bench_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "bench/bench_scene.h"
#include "bench/results/comparability.h"
#include "commands/bench/bench_plan.h"
#include "commands/bench/bench_rows.h"
#include "commands/bench/bench_summary.h"
#include "commands/bench/bench_trace.h"
#include "commands/bench/bench_verdict.h"
#include "commands/bench/earlier_rows.h"
#include "commands/bench/planned_scenes.h"
#include "commands/bench/structure.h"
#include "commands/bench/time_budget.h"
#include "commands/bench/verified_rows.h"
#include "commands/shared/choices.h"
#include "commands/shared/exit_code.h"
#include "commands/shared/fit_body.h"
#include "commands/shared/opencl_notes.h"
#include "commands/shared/prepared_scene.h"
#include "commands/shared/progress_line.h"
#include "commands/shared/run_provenance.h"
#include "commands/shared/stop_request.h"
#include "commands/shared/tell_first.h"
#include "integrators/integrators.h"
#include "output/folders/result_folder.h"
#include "output/tables/published.h"
#include "output/tables/result_table.h"
#include "output/traces/trace_name.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "text/nearest_name.h"
#include "text/printable.h"

namespace mssim {
namespace {

void add_published_times(std::vector<ResultRow>& rows, const std::vector<const BackendInfo*>& backends,
                         const std::vector<PublishedTable>& published) {
  for (ResultRow& row : rows) {
    const BackendInfo& backend = **std::ranges::find(backends, row.backend, &BackendInfo::name);
    for (const PublishedTable& table : published)
      if (const auto ms = table.ms(find_integrator(row.integrator)->paper_name, backend.paper_configuration,
                                   row.nodes, row.springs_published))
        row.paper_ms = ms;
  }
}

/// Measures the plan's scenes, but for what an earlier run has done of them already, and writes the folder
/// after every round. Ends early when it is asked to.
void time_scenes(SceneJob job, const std::vector<std::string>& names, const BenchOptions& options,
                 const std::vector<PublishedTable>& published, const ResultFolder* folder,
                 const StopRequest& stop, TimeBudget& budget, BenchRows& rows) {
  ProgressLine progress(names.size());
  for (const std::string& name : names) {
    job.deadline = budget.begin_scene();
    job.name = find_scene(name).name;
    job.earlier = rows.of_scene(job.name);
    progress.begin_scene(job.name);
    const bool finished = is_finished(job, job.name, job.earlier);
    if (finished && !options.trace) continue;
    const PreparedScene scene = prepare_scene(name);
    warn_of_note(scene);
    job.system = &scene.system;
    job.springs_published = scene.counts.springs_published;
    job.note = scene.note;
    job.dt_s = scene.dt_s;
    job.garment.reset();
    if (is_garment(scene.system)) job.garment.emplace(GarmentJob{.body = fit_body(scene.spec)});
    const auto keep = [&](std::vector<ResultRow> measured) {
      require_resumable(differences(job.earlier, measured), options.out);
      add_published_times(measured, job.backends, published);
      rows.replace(job.name, std::move(measured));
      if (folder) folder->write(rows.all());
    };
    bool first_round = true;
    const BenchWatch watch{
        .progress = [&](const std::string& activity, double done) { progress.update(activity, done); },
        .after_round =
            [&](const std::vector<ResultRow>& measured) {
              if (std::exchange(first_round, false)) budget.first_round_done();
              keep(measured);
            },
        .stop = [&] { return stop.requested(); }};
    if (!finished) {
      std::vector<ResultRow> measured = bench_scene(job, watch);
      if (!measured.empty()) keep(std::move(measured));
    }
    if (options.trace && !stop.requested())
      write_bench_traces(job, scene, rows.of_scene(job.name), std::filesystem::path(options.out) / "traces",
                         options.resume, watch);
    if (stop.requested()) return;
  }
}

/// Before hours of measuring, not after.
void warn_of_missing_speedups(const BenchPlan& plan) {
  std::vector<std::string_view> backends;
  if (!plan.timed.empty())
    for (const BackendInfo* backend : plan.job.backends) backends.push_back(backend->name);
  if (const std::string reason = reason_without_speedups(backends); !reason.empty())
    std::cerr << "mssim: " << reason << '\n';
}

std::vector<StructureRow> describe_scenes(const std::vector<std::string>& names) {
  std::vector<StructureRow> rows;
  for (const std::string& name : names) {
    const PreparedScene scene = prepare_scene(name);
    warn_of_note(scene);
    rows.push_back(structure_of(scene));
  }
  return rows;
}

/// Rows and results are told apart by their scene's name.
void require_distinct_names(const std::vector<SceneSpec>& scenes) {
  for (auto scene = scenes.begin(); scene != scenes.end(); ++scene)
    for (auto other = scenes.begin(); other != scene; ++other)
      if (other->name == scene->name)
        throw UsageError("there are two scenes called " + printable(scene->name) + ", " +
                         printable(other->file.string()) + " and " + printable(scene->file.string()) +
                         "; name one of them, or rename a file");
}

int run(const BenchOptions& options) {
  // Everything that can be wrong with the input is found before the first measurement.
  BenchPlan plan = plan_of(options);
  const bool uses_device =
      !plan.timed.empty() && std::ranges::any_of(plan.job.backends, &BackendInfo::uses_device);
  Provenance provenance = run_provenance(plan.job.execution.threads, uses_device && !options.dry_run);
  provenance.device_memory = name_of(plan.job.execution.memory);
  for (const std::string& name : plan.described) {
    const SceneSpec spec = find_scene(name);
    require_memory(spec);
    add_scene(provenance, spec.name, spec.source);
  }
  std::vector<SceneSpec> timed;
  for (const std::string& name : plan.timed) {
    const SceneSpec& spec = timed.emplace_back(find_scene(name));
    if (options.trace && std::holds_alternative<GarmentSpec>(spec.body))
      throw UsageError(
          "--trace does not go with " + spec.name +
          ", which is a garment: what it is verified with is no continuous motion; leave it out");
    if (options.trace) {
      if (const auto problem = trace_name_problem(spec.name + ".h5"))
        throw UsageError("--trace names traces after their scene, and " + *problem);
    }
    add_scene(provenance, spec.name, spec.source);
  }
  require_distinct_names(timed);
  if (!options.verified.empty()) plan.job.verified = verified_rows(options.verified, provenance, plan);
  const std::vector<PlannedScene> scenes = planned_scenes(plan);
  TimeBudget budget(options.time_budget_s, times_of(scenes));
  if (options.dry_run) {
    tell_plan(plan, scenes, options.time_budget_s);
    return exit_ok;
  }
  const std::vector<PublishedTable> published = published_tables();
  std::optional<ResultFolder> folder;
  if (!options.out.empty()) folder.emplace(options.out, provenance, plan.tables);
  BenchRows rows(folder ? earlier_rows(*folder, provenance, options) : std::vector<ResultRow>());
  if (folder) folder->begin();

  if (!plan.timed.empty())
    for (const std::string& noise : provenance.noise) std::cerr << "mssim: noise: " << noise << '\n';
  if (uses_device) tell_of_opencl();
  warn_of_missing_speedups(plan);
  int code = exit_ok;
  if (!plan.described.empty()) {
    const std::vector<StructureRow> structure = describe_scenes(plan.described);
    if (folder) folder->write(structure);
    std::cout << summary(structure, options.format);
  }
  StopRequest stop;
  if (!plan.timed.empty()) {
    time_scenes(plan.job, plan.timed, options, published, folder ? &*folder : nullptr, stop, budget, rows);
    if (!plan.described.empty() && options.format == SummaryFormat::table) std::cout << '\n';
    std::cout << summary(rows.all(), options.format, plan.job.execution.threads);
    if (folder && options.format == SummaryFormat::github) folder->write_for_github(rows.all());
    const BenchVerdict verdict = verdict_of(rows.all(), options.backends, options.integrators);
    tell_first(verdict.reasons);
    code = verdict.exit_code;
  }
  if (folder && stop.requested())
    std::cerr << "mssim: " << (rows.all().empty() ? "nothing was measured yet" : "results so far are in ")
              << (rows.all().empty() ? "" : escaped(options.out)) << "; --resume goes on\n";
  else if (folder)
    std::cerr << "mssim: results are in " << escaped(options.out) << '\n';
  stop.throw_if_requested();
  return code;
}

}  // namespace

std::function<int()> declare_bench(CLI::App& app) {
  const auto options = std::make_shared<BenchOptions>();
  const std::vector<std::string> names = suite_names();
  const std::vector<std::string_view> suites(names.begin(), names.end());
  add_scenes(app, "--scene", options->scenes, "Scenes to measure: names (see mssim list scenes) or files");
  app.add_option("--suite", options->suite,
                 "Scenes and what is compared on them: " + listed(suites, "or") +
                     " (see mssim list suites); tables stands for table1, table2 and table3")
      ->transform(one_of("suite", names))
      ->type_name("NAME");
  app.add_option("--backend", options->backends, "Backends, or ways with --suite races (default: all)")
      ->delimiter(',')
      ->type_name("NAME,...");
  app.add_option("--integrator", options->integrators,
                 "Integrators, or all (default: semi-euler,midpoint,rk4; with --suite races, scaling or "
                 "garment semi-euler)")
      ->delimiter(',')
      ->type_name("NAME,...");
  declare_execution(app, options->execution);
  app.add_option("--rounds", options->rounds,
                 "Samples of each combination (default: 15; with --time-budget at most so many)")
      ->check(whole_number(1, most_rounds))
      ->type_name("N");
  app.add_option("--time-budget", options->time_budget_s,
                 "Time that the measurement is to take, in as many rounds as fit; traces come on top")
      ->check(positive_number())
      ->type_name("SECONDS");
  app.add_flag("--dry-run", options->dry_run,
               "Print what would be measured and about how long it would take, and do nothing");
  app.add_option("--out", options->out, "Folder for the results: tables, samples, provenance")
      ->type_name("FOLDER");
  CLI::Option* resume = app.add_flag(
      "--resume", options->resume,
      "Go on where an earlier run of the same command ended, whatever ended it: keep what the folder has");
  app.add_flag("--overwrite", options->overwrite, "Replace the results that the folder has")
      ->excludes(resume);
  app.add_flag("--trace", options->trace,
               "Trace each combination too, after it has been timed, into FOLDER/traces");
  add_choice<SummaryFormat>(app, "--format", options->format,
                            {{"table", SummaryFormat::table},
                             {"csv", SummaryFormat::csv},
                             {"json", SummaryFormat::json},
                             {"github", SummaryFormat::github}},
                            "What to print: table, csv, json, or github, what github-action-benchmark reads, "
                            "which is written into FOLDER too (default: table)");
  app.add_option("--verified", options->verified,
                 "Result folder in which this program has verified all this already: take from there what is "
                 "right, and only take samples")
      ->type_name("FOLDER");
  return [options] { return run(*options); };
}

}  // namespace mssim
