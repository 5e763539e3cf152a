#include "commands/bench_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bench/bench_memory.h"
#include "bench/bench_scene.h"
#include "commands/bench_plan.h"
#include "commands/bench_summary.h"
#include "commands/bench_trace.h"
#include "commands/choices.h"
#include "commands/exit_code.h"
#include "commands/prepared_scene.h"
#include "commands/progress_line.h"
#include "commands/run_provenance.h"
#include "commands/structure.h"
#include "integrators/integrators.h"
#include "output/listing.h"
#include "output/published.h"
#include "output/result_folder.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"

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

/// 1 when a measured row is wrong; 3 when a backend that was asked for by name could not run.
int exit_code_of(const std::vector<ResultRow>& rows, const BenchOptions& options) {
  int code = exit_ok;
  for (const ResultRow& row : rows) {
    if (row.status == "ok" && row.verified) continue;
    if (row.status.starts_with("failed") || row.status == "ok") return exit_not_verified;
    const auto& asked = options.backends;
    if (std::find(asked.begin(), asked.end(), row.backend) != asked.end()) code = exit_unavailable;
  }
  return code;
}

std::vector<ResultRow> time_scenes(SceneJob job, const std::vector<std::string>& names,
                                   const BenchOptions& options, const std::vector<PublishedTable>& published,
                                   const ResultFolder* folder) {
  std::vector<ResultRow> rows;
  ProgressLine progress(names.size());
  for (const std::string& name : names) {
    const PreparedScene scene = prepare_scene(name);
    warn_of_difference(scene);
    job.name = scene.spec.name;
    job.system = &scene.system;
    job.springs_published = scene.counts.springs_published;
    job.note = scene.note;
    job.dt_s = scene.dt_s;
    progress.begin_scene(job.name);
    std::vector<ResultRow> measured =
        bench_scene(job, [&](const std::string& activity, double done) { progress.update(activity, done); });
    add_published_times(measured, job.backends, published);
    rows.insert(rows.end(), measured.begin(), measured.end());
    if (folder) folder->write(rows);
    if (options.trace)
      write_bench_traces(job, scene, measured, std::filesystem::path(options.out) / "traces",
                         [&](const std::string& activity) { progress.update(activity, 1); });
  }
  return rows;
}

std::vector<StructureRow> describe_scenes(const std::vector<std::string>& names) {
  std::vector<StructureRow> rows;
  for (const std::string& name : names) {
    const PreparedScene scene = prepare_scene(name);
    warn_of_difference(scene);
    rows.push_back(structure_of(scene));
  }
  return rows;
}

/// A user shall not wait for a scene only to see the program killed.
void require_memory_for(const SceneJob& job, const SceneSpec& spec) {
  const SceneCounts counts = counts_of(spec);
  const bool grid = std::holds_alternative<ClothSpec>(spec.body);
  require_memory(spec, counts, bench_memory_needed(job, {counts.nodes, counts.springs_unique, grid}),
                 "name fewer with --backend or --integrator, or make the scene smaller");
}

int run(const BenchOptions& options) {
  // Everything that can be wrong with the input is found before the first measurement.
  const BenchPlan plan = plan_of(options);
  Provenance provenance = run_provenance(plan.job.execution.threads);
  for (const std::string& name : plan.described) {
    const SceneSpec spec = find_scene(name);
    require_memory(spec);
    add_scene(provenance, spec.name, spec.source);
  }
  for (const std::string& name : plan.timed) {
    const SceneSpec spec = find_scene(name);
    require_memory_for(plan.job, spec);
    add_scene(provenance, spec.name, spec.source);
  }
  const std::vector<PublishedTable> published = published_tables();
  std::optional<ResultFolder> folder;
  if (!options.out.empty()) folder.emplace(options.out, provenance, plan.tables);

  int code = exit_ok;
  if (!plan.described.empty()) {
    const std::vector<StructureRow> rows = describe_scenes(plan.described);
    if (folder) folder->write(rows);
    std::cout << to_text(summary(rows), ListingFormat::table);
  }
  if (!plan.timed.empty()) {
    const std::vector<ResultRow> rows =
        time_scenes(plan.job, plan.timed, options, published, folder ? &*folder : nullptr);
    std::cout << (plan.described.empty() ? "" : "\n") << to_text(summary(rows), ListingFormat::table);
    code = exit_code_of(rows, options);
  }
  if (folder) std::cerr << "mssim: results are in " << options.out << '\n';
  return code;
}

}  // namespace

std::function<int()> declare_bench(CLI::App& app) {
  const auto options = std::make_shared<BenchOptions>();
  app.add_option("--scene", options->scenes, "Scenes: names (see mssim list scenes) or files")
      ->delimiter(',');
  app.add_option("--suite", options->suite,
                 "Scenes and what is compared on them (see mssim list suites); all: the tables of the paper")
      ->check(CLI::IsMember(suite_names()));
  app.add_option("--backend", options->backends, "Backends, or ways with --suite races (default: all)")
      ->delimiter(',');
  app.add_option(
         "--integrator", options->integrators,
         "Integrators, or all (default: semi-euler,midpoint,rk4; with --suite races or scaling semi-euler)")
      ->delimiter(',');
  declare_execution(app, options->execution);
  app.add_option("--rounds", options->rounds, "Samples of each combination (default: 15)")
      ->check(CLI::Range(1, 100000));
  app.add_flag("--trace", options->trace,
               "Trace each combination too, after it has been timed, into OUT/traces");
  app.add_option("--out", options->out, "Folder for the results: tables, samples, provenance");
  return [options] { return run(*options); };
}

}  // namespace mssim
