#include "scene/scene_kinds.h"

#include <array>
#include <string>
#include <variant>

#include "garment/scene/garment_scene.h"
#include "scene/bodies.h"
#include "scene/cloth.h"
#include "scene/spec/memory.h"

namespace mssim {
namespace {

constexpr std::array<SceneKind, 3> kinds{{
    // The published counts of cloths take the 12-neighbour stencil of every node, and so each spring from
    // both of its ends.
    {"cloth", visit_cloth_fields, check_cloth, 2, stated_cloth_counts, cloth_counts, build_cloth},
    // Those of bodies seem to be the length of the array of packed springs, three values each: all nine can
    // be divided by three, and the thirds fit tetrahedral meshes.
    {"bodies", visit_bodies_fields, check_bodies, 3, stated_bodies_counts, bodies_counts, build_bodies},
    {"garment", visit_garment_fields, check_garment, std::nullopt, stated_garment_counts, garment_counts,
     build_garment_scene},
}};
static_assert(kinds.size() == std::variant_size_v<decltype(SceneSpec::body)>);

SceneCounts with_published(const SceneSpec& spec, SceneCounts counts) {
  if (const auto per_spring = kind_of(spec).published_per_spring)
    counts.springs_published = *per_spring * counts.springs_unique;
  return counts;
}

}  // namespace

std::span<const SceneKind> scene_kinds() { return kinds; }

const SceneKind& kind_of(const SceneSpec& spec) { return kinds.at(spec.body.index()); }

std::optional<SceneCounts> stated_counts(const SceneSpec& spec) {
  const auto stated = kind_of(spec).stated(spec);
  return stated ? std::optional(with_published(spec, *stated)) : std::nullopt;
}

SceneCounts counts_of(const SceneSpec& spec) { return with_published(spec, kind_of(spec).counts(spec)); }

SceneCounts counts_of(const SceneSpec& spec, const System& system) {
  return with_published(spec, {system.nodes(), system.springs.size()});
}

void require_memory(const SceneSpec& spec) {
  const SceneCounts counts = counts_of(spec);
  require_memory(spec, counts, memory_needed(counts.nodes, counts.springs_unique), "make the scene smaller");
}

void require_memory(const SceneSpec& spec, const SceneCounts& counts, std::uint64_t needed,
                    std::string_view remedy) {
  require_memory(spec, "/" + std::string(kind_of(spec).name), counts, needed, remedy);
}

System build_system(const SceneSpec& spec) {
  require_memory(spec);
  System system = kind_of(spec).build(spec);
  round_to_single(system.start);
  round_to_single(system.floor.height);
  return system;
}

}  // namespace mssim
