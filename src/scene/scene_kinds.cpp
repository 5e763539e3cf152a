#include "scene/scene_kinds.h"

#include <array>
#include <string>
#include <variant>

#include "scene/bodies.h"
#include "scene/cloth.h"
#include "scene/memory.h"

namespace mssim {
namespace {

constexpr std::array<SceneKind, 2> kinds{{
    {"cloth", visit_cloth_fields, check_cloth, stated_cloth_counts, cloth_counts, build_cloth},
    {"bodies", visit_bodies_fields, check_bodies, stated_bodies_counts, bodies_counts, build_bodies},
}};
static_assert(kinds.size() == std::variant_size_v<decltype(SceneSpec::body)>);

}  // namespace

std::span<const SceneKind> scene_kinds() { return kinds; }

const SceneKind& kind_of(const SceneSpec& spec) { return kinds.at(spec.body.index()); }

std::optional<SceneCounts> stated_counts(const SceneSpec& spec) { return kind_of(spec).stated(spec); }

SceneCounts counts_of(const SceneSpec& spec) { return kind_of(spec).counts(spec); }

void require_memory(const SceneSpec& spec) {
  require_memory(spec, "/" + std::string(kind_of(spec).name), counts_of(spec));
}

System build_system(const SceneSpec& spec) {
  require_memory(spec);
  System system = kind_of(spec).build(spec);
  round_to_single(system.start);
  round_to_single(system.floor.height);
  return system;
}

}  // namespace mssim
