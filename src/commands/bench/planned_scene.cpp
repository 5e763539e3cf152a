#include "commands/bench/planned_scene.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "bench/windows/windows.h"
#include "commands/shared/backend_choice.h"
#include "integrators/stability.h"
#include "platform/machine.h"
#include "scene/cloth.h"
#include "scene/scene_kinds.h"
#include "text/error.h"

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

}  // namespace

PlannedScene planned_scene(UnbuiltScene scene, const BenchSettings& settings) {
  const SceneCounts counts = scene.parts.counts;
  const SceneSize size = size_of(scene.spec, counts);
  std::uint64_t memory_bytes = bench_memory_needed(settings, size);
  const bool can = size.grid && std::ranges::all_of(settings.backends, [](const BackendInfo* backend) {
                     return has_windows(*backend);
                   });
  if (settings.windows && !can)
    throw UsageError("--windows goes with cloths and backends that have windows, as --backend mpi: " +
                     scene.spec.name + " and the chosen backends are others; leave it out");
  std::vector<GridWindow> windows;
  if (can && (settings.windows || memory_shortage(memory_bytes))) {
    const auto& cloth = std::get<ClothSpec>(scene.spec.content);
    const GridPatch grid{cloth.rows, cloth.columns, cloth.spacing_m};
    const auto ranks = static_cast<std::size_t>(most_ranks_of(settings.backends, settings.execution));
    const std::size_t count =
        settings.windows ? static_cast<std::size_t>(*settings.windows) : usual_windows(ranks);
    if (count < fewest_windows(ranks))
      throw UsageError("--windows " + std::to_string(count) + " leaves some of " + std::to_string(ranks) +
                       " ranks without one: give at least " + std::to_string(fewest_windows(ranks)));
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

PreparedScene outline_of(const PlannedScene& planned) {
  PreparedScene scene;
  scene.spec = planned.spec;
  scene.system = outline_of_cloth(scene.spec);
  round_start_to_single(scene.system);
  scene.counts = planned.parts.counts;
  if (scene.spec.dt_s) {
    scene.dt_s = *scene.spec.dt_s;
    return scene;
  }
  // Nodes of all kinds, and around some of them every spring that a node has.
  constexpr std::uint32_t all_kinds = 9;
  const auto& cloth = std::get<ClothSpec>(scene.spec.content);
  scene.dt_s = auto_dt(mode_bound(build_window(
      scene.spec, {.rows = std::min(cloth.rows, all_kinds), .columns = std::min(cloth.columns, all_kinds)})));
  return scene;
}

System build_window(const SceneSpec& spec, const GridWindow& window) {
  System system = build_cloth_window(spec, window);
  system.springs = springs_of(std::get<GridPatch>(system.topology));
  round_start_to_single(system);
  return system;
}

std::vector<ExpectedTime> times_of(const std::vector<PlannedScene>& scenes) {
  std::vector<ExpectedTime> times;
  for (const PlannedScene& scene : scenes) times.push_back(scene.time);
  return times;
}

}  // namespace mssim
