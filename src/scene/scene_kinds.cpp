#include "scene/scene_kinds.h"

#include <fmt/core.h>

#include <array>
#include <variant>

#include "platform/machine.h"
#include "scene/fields/fields.h"

namespace mssim {

namespace {

template <class... Specs>
constexpr std::array<const SceneKind*, sizeof...(Specs)> kinds_in(std::variant<Specs...> SceneSpec::*) {
  return {&Specs::kind...};
}
constexpr auto table = kinds_in(&SceneSpec::content);

SceneCounts with_published(const SceneSpec& spec, SceneCounts counts) {
  if (const auto per_spring = kind_of(spec).published_per_spring)
    counts.springs_published = *per_spring * counts.springs_unique;
  return counts;
}

}  // namespace

std::span<const SceneKind* const> scene_kinds() { return table; }

const SceneKind& kind_of(const SceneSpec& spec) { return *table.at(spec.content.index()); }

std::optional<SceneCounts> stated_counts(const SceneSpec& spec) {
  const std::optional<SceneCounts> counts = kind_of(spec).stated(spec);
  return counts ? std::optional(with_published(spec, *counts)) : std::nullopt;
}

SceneParts read_parts(const SceneSpec& spec) {
  SceneParts parts = kind_of(spec).read(spec);
  parts.counts = with_published(spec, parts.counts);
  parts.files.push_back(spec.file);
  return parts;
}

SceneCounts counts_of(const SceneSpec& spec) { return read_parts(spec).counts; }

void require_memory(const SceneSpec& spec, const SceneCounts& counts) {
  require_memory(spec, counts, memory_needed(counts), "make the scene smaller");
}

void require_memory(const SceneSpec& spec, const SceneCounts& counts, std::uint64_t needed,
                    std::string_view remedy) {
  if (const auto shortage = memory_shortage(needed))
    refuse(spec.file, fmt::format("/{}", kind_of(spec).name),
           fmt::format("has {} nodes and {} springs and {}: {}", counts.nodes, counts.springs_unique,
                       *shortage, remedy));
}

std::uint64_t memory_needed(const SceneCounts& counts) {
  constexpr std::uint64_t start = 1, reference_pairs = 4, read_back = 1;
  return counts.nodes * (start + reference_pairs + read_back) * 2 * sizeof(Vec3d) +
         counts.springs_unique * sizeof(Spring);
}

BuiltScene build_scene(const SceneSpec& spec, const SceneParts& parts) {
  require_memory(spec, parts.counts);
  BuiltScene scene = parts.build(spec);
  round_start_to_single(scene.system);
  return scene;
}

BuiltScene build_scene(const SceneSpec& spec) { return build_scene(spec, read_parts(spec)); }

System build_system(const SceneSpec& spec) { return build_scene(spec).system; }

}  // namespace mssim
