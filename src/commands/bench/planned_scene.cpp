#include "commands/bench/planned_scene.h"

#include <utility>
#include <variant>

#include "scene/scene_kinds.h"

namespace mssim {

SceneSize size_of(const SceneSpec& spec, const SceneCounts& counts) {
  return {counts.nodes, counts.springs_unique, std::holds_alternative<ClothSpec>(spec.content),
          std::holds_alternative<GarmentSpec>(spec.content)};
}

PreparedScene UnbuiltScene::prepare() { return prepare_scene(spec, std::exchange(parts, {})); }

PlannedScene planned_scene(UnbuiltScene scene, const BenchSettings& settings) {
  const SceneCounts counts = scene.parts.counts;
  const SceneSize size = size_of(scene.spec, counts);
  const std::uint64_t memory_bytes = bench_memory_needed(settings, size);
  require_memory(scene.spec, counts, memory_bytes,
                 "name fewer with --backend or --integrator, or make the scene smaller");
  return {std::move(scene), size, memory_bytes, expected_time(settings, size)};
}

std::vector<ExpectedTime> times_of(const std::vector<PlannedScene>& scenes) {
  std::vector<ExpectedTime> times;
  for (const PlannedScene& scene : scenes) times.push_back(scene.time);
  return times;
}

}  // namespace mssim
