#include "application/bench/bench_plan.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <utility>
#include <variant>

#include "application/bench/bench_results.h"
#include "application/bench/suites.h"
#include "application/outputs.h"
#include "bench/verification/verification.h"
#include "bench/windows/windows.h"
#include "integrators/stability.h"
#include "output/traces/h5md_trace.h"
#include "platform/files.h"
#include "platform/machine.h"
#include "scene/builders.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {

SceneSize size_of(const SceneSpec& spec, const SceneCounts& counts) {
  return {counts.nodes, counts.springs_unique, std::holds_alternative<ClothSpec>(spec.content),
          std::holds_alternative<GarmentSpec>(spec.content)};
}

PreparedScene UnbuiltScene::prepare() { return prepare_scene(spec, std::exchange(parts, {})); }

namespace {

/// Bytes of the references of windows that run at the same time.
std::uint64_t window_memory(const BenchSettings& settings, const GridWindow& window, const GridPatch& grid) {
  double most = 0;
  for (const Integrator* integrator : settings.integrators)
    if (!is_implicit(*integrator)) most = std::max(most, window_reference_bytes(*integrator, window, grid));
  return static_cast<std::uint64_t>(most) * static_cast<std::uint64_t>(settings.execution.threads);
}

/// The scene's time step. If it is `auto`, builds some nodes of a cloth, and the whole of another scene.
double dt_of(const SceneSpec& spec, const SceneParts& parts) {
  if (spec.dt_s) return *spec.dt_s;
  const auto* cloth = std::get_if<ClothSpec>(&spec.content);
  if (cloth == nullptr) return prepare_scene(spec, parts).dt_s;
  // Nodes of all kinds, and around some of them every spring that a node has.
  constexpr std::uint32_t all_kinds = 9;
  return auto_dt(mode_bound(build_window(
      spec, {.rows = std::min(cloth->rows, all_kinds), .columns = std::min(cloth->columns, all_kinds)})));
}

/// A cloth whose backends all have windows gets some if `asked_windows`, their number, is there, or if the
/// whole does not fit. Throws UsageError if they are requested and cannot be had. Throws SceneError if the
/// scene needs more memory than there is: nobody should wait for a scene only to see the program killed.
PlannedScene planned_scene(UnbuiltScene scene, const BenchSettings& settings,
                           std::optional<int> asked_windows) {
  const SceneCounts counts = scene.parts.counts;
  SceneSize size = size_of(scene.spec, counts);
  if (settings.fps) {
    const double dt_s = dt_of(scene.spec, scene.parts);
    if (1 / (*settings.fps * dt_s) > most_frame_steps)
      throw UsageError("--fps {:.6g} makes frames of more than {} steps of {:.6g} s on {}: give more",
                       *settings.fps, grouped(static_cast<std::uint64_t>(most_frame_steps)), dt_s,
                       scene.spec.name);
    if (*settings.fps * dt_s > 1)
      throw UsageError(
          "--fps {:.6g} makes frames shorter than a step of {:.6g} s on {}: give a smaller number",
          *settings.fps, dt_s, scene.spec.name);
    size.frame_steps = steps_of_frame(*settings.fps, dt_s);
  }
  std::uint64_t memory_bytes = bench_memory_needed(settings, size);
  const bool can = size.grid && std::ranges::all_of(settings.backends, [](const BackendInfo* backend) {
                     return has_windows(*backend);
                   });
  if (asked_windows && !can)
    throw UsageError("--windows goes with cloths and backends that have windows, as --backend mpi: " +
                     scene.spec.name + " and the chosen backends are others; leave it out");
  std::vector<GridWindow> windows;
  if (can && (asked_windows || memory_shortage(memory_bytes))) {
    const auto& cloth = std::get<ClothSpec>(scene.spec.content);
    const GridPatch grid{cloth.rows, cloth.columns, cloth.spacing_m};
    const auto ranks = static_cast<std::size_t>(most_ranks_of(settings.backends, settings.execution));
    const std::size_t count = asked_windows ? static_cast<std::size_t>(*asked_windows) : usual_windows(ranks);
    if (count < fewest_windows(ranks))
      throw UsageError("--windows {} leaves some of {} ranks without one: give at least {}", count, ranks,
                       fewest_windows(ranks));
    windows = choose_windows(
        grid, ranks, cloth.pins ? std::optional<std::uint32_t>(cloth.pins->row) : std::nullopt, count);
    memory_bytes = window_memory(settings, windows.front(), grid);
  }
  std::string remedy = "name fewer with --backend or --integrator, or make the scene smaller";
  if (size.grid && windows.empty()) remedy += "; a cloth with --backend mpi alone can be verified in windows";
  require_memory(scene.spec, counts, memory_bytes, remedy);
  return {std::move(scene),  settings.backends, size, memory_bytes, expected_time(settings, size),
          std::move(windows)};
}

std::vector<std::string> timed_names(const BenchOptions& options) {
  std::vector<std::string> scenes = scenes_of_suite(options.suite, true);
  for (const std::string& scene : options.scenes) add_once(scenes, scene);
  return scenes;
}

/// The requested ones, or else all of the table and, where the suite compares them, all that are described.
std::vector<const BackendInfo*> backends_of(const BenchOptions& options, const Comparison& comparison,
                                            const ExecutionOptions& execution, BackendChoice& choice) {
  if (!options.backends.empty()) return choice.require_all(options.backends);
  std::vector<const BackendInfo*> all = comparison.backends();
  if (comparison.programs)
    for (const std::string& name : comparison.programs(execution)) all.push_back(&choice.require(name));
  if (!comparison.described_too) return all;
  if (choice.described().empty())
    throw UsageError("--suite " + options.suite +
                     " compares backends that are described in files, and there are none: run scripts/peers, "
                     "which makes some, or give their --backend-folder");
  std::ranges::copy(choice.own(), std::back_inserter(all));
  return all;
}

/// The requested instruction sets, the best first.
std::vector<std::string_view> sets_of(const BenchOptions& options) {
  std::vector<std::string_view> asked, sets;
  for (const std::string& name : options.instruction_sets) asked.push_back(require_instruction_set(name));
  for (const std::string_view set : asked.empty() ? asked : instruction_sets())
    if (std::ranges::find(asked, set) != asked.end()) sets.push_back(set);
  return sets;
}

BenchSettings settings_of(const BenchOptions& options, const Comparison& comparison, BackendChoice& choice) {
  BenchSettings settings;
  ExecutionOptions execution = options.execution;
  if (execution.threads == 0) execution.threads = comparison.threads;
  const std::vector<std::string_view> sets = sets_of(options);
  if (!sets.empty()) execution.instruction_set = sets.front();
  settings.execution = complete(execution);
  settings.backends =
      choice.with_lesser_sets(backends_of(options, comparison, settings.execution, choice), sets);
  settings.backends = choice.with_fewer_threads(settings.backends, options.threads, settings.execution);
  require_use_of_options(options.execution, settings.backends);
  settings.integrators = chosen_integrators(options.integrators, comparison.integrators);
  settings.fps = options.fps;
  settings.rounds = options.rounds.value_or(options.time_budget_s ? most_rounds : usual_rounds);
  return settings;
}

void require_folder_where_needed(const BenchOptions& options) {
  const BenchOutput& output = options.output;
  if (!output.folder.empty()) return;
  if (options.fps && !options.dry_run)
    throw UsageError("--fps times frames for the result folder: give --out too");
  if (output.trace) throw UsageError("--trace writes into the result folder: give --out too");
  if (output.resume || output.overwrite)
    throw UsageError(std::string(output.resume ? "--resume" : "--overwrite") +
                     " needs the folder of an earlier run: give --out too");
}

/// The settings with the backends that the suite has for this scene. A user who names backends or threads
/// gets those and no variants.
BenchSettings settings_of_scene(const BenchSettings& all, const Comparison& comparison,
                                const BenchOptions& options, const std::string& scene,
                                BackendChoice& choice) {
  BenchSettings settings = all;
  if (options.backends.empty() && options.execution.threads == 0)
    settings.backends = choice.with_variants(settings.backends, variants_of_suite(options.suite, scene));
  if (comparison.is_compared)
    std::erase_if(settings.backends,
                  [&](const BackendInfo* backend) { return !comparison.is_compared(scene, backend->name); });
  return settings;
}

void require_traceable(const SceneSpec& spec) {
  if (std::holds_alternative<GarmentSpec>(spec.content))
    throw UsageError(
        "--trace cannot be used with {}, which is a garment: its verification is not a continuous motion; "
        "leave --trace out, and trace the dressing with mssim run --trace",
        spec.name);
  if (const auto problem = trace_name_problem(spec.name + ".h5"))
    throw UsageError("--trace names traces after their scene, and " + *problem);
}

}  // namespace

PreparedScene outline_of(const PlannedScene& planned) {
  PreparedScene scene;
  scene.spec = planned.spec;
  scene.system = outline_of_cloth(scene.spec);
  round_start_to_single(scene.system);
  scene.counts = planned.parts.counts;
  scene.dt_s = dt_of(scene.spec, planned.parts);
  return scene;
}

System build_window(const SceneSpec& spec, const GridWindow& window) {
  System system = build_cloth_window(spec, window);
  system.springs = springs_of(std::get<GridPatch>(system.topology));
  round_start_to_single(system);
  return system;
}

std::vector<ExpectedTime> times_of(const std::vector<PlannedScene>& scenes) {
  return mapped<ExpectedTime>(scenes, &PlannedScene::time);
}

double expected_rounds(const BenchPlan& plan) {
  const double most = plan.settings.rounds;
  return plan.time_budget_s ? std::min(most, rounds_within(*plan.time_budget_s, total(times_of(plan.timed))))
                            : most;
}

BenchPlan plan_of(const BenchOptions& options) {
  const Comparison& comparison = comparison_of_suite(options.suite);
  BenchPlan plan;
  plan.backends =
      BackendChoice(with_garment_backends(comparison.backends()), options.own_backends, options.scenes);
  plan.settings = settings_of(options, comparison, plan.backends);
  plan.time_budget_s = options.time_budget_s;
  plan.output = options.output;
  const std::vector<std::string> timed_ones = timed_names(options);
  const std::vector<std::string> described_ones = scenes_of_suite(options.suite, false);
  if (timed_ones.empty() && described_ones.empty())
    throw UsageError("there is nothing to measure: name a --scene or a --suite");
  require_folder_where_needed(options);
  plan.published = published_tables();
  plan.tables = with_thread_table(comparison.tables());

  std::map<std::filesystem::path, SceneParts> known_parts;  // by the scene's file, each read once
  const auto parts_of = [&](const SceneSpec& spec) {
    auto found = known_parts.find(spec.file);
    if (found == known_parts.end()) found = known_parts.emplace(spec.file, read_parts(spec)).first;
    return found->second;
  };
  for (SceneSpec& spec : mapped<SceneSpec>(described_ones, find_scene)) {
    SceneParts parts = parts_of(spec);
    require_memory(spec, parts.counts);
    plan.described.push_back({std::move(spec), std::move(parts)});
  }
  std::vector<SceneSpec> timed = mapped<SceneSpec>(timed_ones, find_scene);
  std::erase_if(timed, [&](const SceneSpec& spec) {
    return settings_of_scene(plan.settings, comparison, options, spec.name, plan.backends).backends.empty();
  });
  if (options.output.trace) std::ranges::for_each(timed, require_traceable);
  require_distinct_names(timed);

  plan.uses_device = !timed.empty() && std::ranges::any_of(plan.settings.backends, &BackendInfo::uses_device);
  plan.provenance = run_provenance(plan.settings.execution.threads, plan.uses_device && !options.dry_run);
  if (!options.new_references && plan.provenance.program_fnv1a_64)
    plan.settings.references = {cache_folder("references"), *plan.provenance.program_fnv1a_64};
  add_execution(plan.provenance, plan.backends.own(), plan.settings.execution);
  for (const UnbuiltScene& scene : plan.described)
    add_scene(plan.provenance, scene.spec.name, scene.spec.source, scene.parts.files_fnv1a_64);
  for (const SceneSpec& spec : timed)
    add_scene(plan.provenance, spec.name, spec.source, parts_of(spec).files_fnv1a_64);
  if (!options.verified.empty()) plan.settings.verified = verified_rows(options.verified, plan.provenance);
  for (SceneSpec& spec : timed) {
    SceneParts parts = parts_of(spec);
    const BenchSettings settings =
        settings_of_scene(plan.settings, comparison, options, spec.name, plan.backends);
    if (settings.verified) require_rows(*settings.verified, spec.name, settings, options.verified);
    plan.timed.push_back(planned_scene({std::move(spec), std::move(parts)}, settings, options.windows));
    if (options.output.trace && !plan.timed.back().windows.empty())
      throw UsageError("--trace needs the whole of {}, which is verified in windows: leave it out",
                       plan.timed.back().spec.name);
  }
  return plan;
}

}  // namespace mssim
