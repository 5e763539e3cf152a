#include "commands/bench_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "backends/backends.h"
#include "bench/bench_scene.h"
#include "commands/bench_trace.h"
#include "commands/choices.h"
#include "commands/exit_code.h"
#include "commands/prepared_scene.h"
#include "commands/progress_line.h"
#include "commands/run_provenance.h"
#include "commands/structure.h"
#include "commands/suites.h"
#include "integrators/integrators.h"
#include "output/listing.h"
#include "output/result_folder.h"
#include "scene/nearest_name.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"

namespace mssim {
namespace {

struct BenchOptions {
  std::vector<std::string> scenes;
  std::string suite;
  std::vector<std::string> backends;
  std::vector<std::string> integrators;
  ExecutionOptions execution;
  int rounds = 15;
  bool trace = false;
  std::string out;
};

std::vector<std::string> timed_scenes_of(const BenchOptions& options) {
  std::vector<std::string> scenes = scenes_of_suite(options.suite, true);
  for (const std::string& scene : options.scenes)
    if (std::find(scenes.begin(), scenes.end(), scene) == scenes.end()) scenes.push_back(scene);
  return scenes;
}

/// All five, or those asked for in the table's order.
std::vector<const BackendInfo*> backends_of(const BenchOptions& options) {
  std::vector<const BackendInfo*> asked, all;
  for (const std::string& name : options.backends) asked.push_back(&require_backend(name));
  for (const BackendInfo& backend : backends())
    if (asked.empty() || std::find(asked.begin(), asked.end(), &backend) != asked.end())
      all.push_back(&backend);
  return all;
}

/// By default the real methods, those that are a paper's integrator under its own name.
std::vector<const Integrator*> integrators_of(const BenchOptions& options) {
  std::vector<const Integrator*> asked, all;
  const bool every = options.integrators == std::vector<std::string>{"all"};
  if (!every)
    for (const std::string& name : options.integrators) asked.push_back(&require_integrator(name));
  for (const Integrator& integrator : integrators) {
    const bool wanted = asked.empty() ? every || integrator.name == integrator.paper_name
                                      : std::find(asked.begin(), asked.end(), &integrator) != asked.end();
    if (wanted) all.push_back(&integrator);
  }
  return all;
}

PaperLegend legend_of() {
  PaperLegend legend;
  for (const BackendInfo& backend : backends())
    legend.backends.push_back({std::string(backend.name), std::string(backend.paper_configuration)});
  for (const Integrator& integrator : integrators)
    legend.integrators.push_back({std::string(integrator.name), std::string(integrator.paper_name),
                                  static_cast<int>(integrator.stage_count)});
  return legend;
}

void add_published_times(std::vector<ResultRow>& rows, const std::vector<PublishedTable>& published) {
  for (ResultRow& row : rows)
    for (const PublishedTable& table : published)
      if (const auto ms =
              table.ms(find_integrator(row.integrator)->paper_name,
                       find_backend(row.backend)->paper_configuration, row.nodes, row.springs_published))
        row.paper_ms = ms;
}

/// The rows for a reader: the columns that answer "how fast, how right".
Listing summary(const std::vector<ResultRow>& rows) {
  const auto number = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
  };
  Listing listing;
  for (const ResultRow& row : rows)
    listing.push_back({{"scene", row.scene},
                       {"nodes", row.nodes},
                       {"springs_published", row.springs_published},
                       {"integrator", row.integrator},
                       {"backend", row.backend},
                       {"ms_per_step", number(row.ms_per_step)},
                       {"low", number(row.ms_per_step_low)},
                       {"high", number(row.ms_per_step_high)},
                       {"speedup", number(row.speedup_vs_serial)},
                       {"paper_ms", number(row.paper_ms)},
                       {"roofline", number(row.roofline_fraction)},
                       {"position_error", number(row.position_error)},
                       {"verified", row.verified},
                       {"status", row.status}});
  return listing;
}

Listing summary(const std::vector<StructureRow>& rows) {
  Listing listing;
  for (const StructureRow& row : rows)
    listing.push_back({{"scene", row.scene},
                       {"nodes", row.nodes},
                       {"springs_unique", row.springs_unique},
                       {"springs_published", row.springs_published},
                       {"tetrahedra", row.tetrahedra},
                       {"smallest_dihedral_angle_deg", row.smallest_dihedral_angle_deg}});
  return listing;
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
    add_published_times(measured, published);
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

int run(const BenchOptions& options) {
  // Everything that can be wrong with the input is found before the first measurement.
  SceneJob job;
  job.backends = backends_of(options);
  job.integrators = integrators_of(options);
  job.execution = complete(options.execution);
  job.rounds = options.rounds;
  const std::vector<std::string> timed = timed_scenes_of(options);
  const std::vector<std::string> described = scenes_of_suite(options.suite, false);
  if (timed.empty() && described.empty())
    throw UsageError("there is nothing to measure: name a --scene or a --suite");
  if (options.trace && options.out.empty())
    throw UsageError("--trace writes into the result folder: give --out too");
  Provenance provenance = run_provenance(job.execution.threads);
  for (const auto* names : {&described, &timed})
    for (const std::string& name : *names) {
      const SceneSpec spec = find_scene(name);
      require_memory(spec);
      add_scene(provenance, spec.name, spec.source);
    }
  const std::vector<PublishedTable> published = published_tables();
  std::optional<ResultFolder> folder;
  if (!options.out.empty()) folder.emplace(options.out, provenance, legend_of(), published);

  int code = exit_ok;
  if (!described.empty()) {
    const std::vector<StructureRow> rows = describe_scenes(described);
    if (folder) folder->write(rows);
    std::cout << to_text(summary(rows), ListingFormat::table);
  }
  if (!timed.empty()) {
    const std::vector<ResultRow> rows =
        time_scenes(job, timed, options, published, folder ? &*folder : nullptr);
    std::cout << (described.empty() ? "" : "\n") << to_text(summary(rows), ListingFormat::table);
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
  app.add_option("--suite", options->suite, "The scenes of a published table")
      ->check(CLI::IsMember(suite_names()));
  app.add_option("--backend", options->backends, "Backends (default: all)")->delimiter(',');
  app.add_option("--integrator", options->integrators,
                 "Integrators, or all (default: semi-euler,midpoint,rk4)")
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
