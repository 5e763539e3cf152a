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

template <System (*build)(const SceneSpec& spec)>
BuiltScene without_note(const SceneSpec& spec) {
  return {build(spec), ""};
}

constexpr std::array<SceneKind, 3> table{{
    // The published counts of cloths take the 12-neighbour stencil of every node, and so each spring from
    // both of its ends.
    {"cloth",
     "A regular cloth, level at first: row r, column c starts at (c spacing, ceiling height, r spacing). "
     "Neighbours are joined by structural springs, diagonal ones by shear springs, those two apart by "
     "bending springs.",
     visit_cloth_fields, check_cloth, 2, stated_cloth_counts, cloth_counts, without_note<build_cloth>},
    // Those of bodies seem to be the length of the array of packed springs, three values each: all nine can
    // be divided by three, and the thirds fit tetrahedral meshes.
    {"bodies",
     "Solid bodies cut into tetrahedra, whose edges are the springs. They fall side by side; only the floor "
     "stops them.",
     visit_bodies_fields, check_bodies, 3, stated_bodies_counts, bodies_counts, without_note<build_bodies>},
    {"garment", "Panels that are drawn together around a body along their seams, and draped.",
     visit_garment_fields, check_garment, std::nullopt, stated_garment_counts, garment_counts,
     build_garment_scene},
}};
static_assert(table.size() == std::variant_size_v<decltype(SceneSpec::content)>);

SceneCounts with_published(const SceneSpec& spec, SceneCounts counts) {
  if (const auto per_spring = kind_of(spec).published_per_spring)
    counts.springs_published = *per_spring * counts.springs_unique;
  return counts;
}

std::string pointer_to_kind(const SceneSpec& spec) { return "/" + std::string(kind_of(spec).name); }

}  // namespace

std::span<const SceneKind> scene_kinds() { return table; }

const SceneKind& kind_of(const SceneSpec& spec) { return table.at(spec.content.index()); }

std::optional<SceneCounts> stated_counts(const SceneSpec& spec) {
  const auto stated = kind_of(spec).stated(spec);
  return stated ? std::optional(with_published(spec, *stated)) : std::nullopt;
}

SceneCounts counts_of(const SceneSpec& spec) { return with_published(spec, kind_of(spec).counts(spec)); }

SceneCounts counts_of(const SceneSpec& spec, const System& system) {
  return with_published(spec, {system.nodes(), system.springs.size()});
}

void require_memory(const SceneSpec& spec) { require_memory(spec, pointer_to_kind(spec), counts_of(spec)); }

void require_memory(const SceneSpec& spec, const SceneCounts& counts, std::uint64_t needed,
                    std::string_view remedy) {
  require_memory(spec, pointer_to_kind(spec), counts, needed, remedy);
}

BuiltScene build_scene(const SceneSpec& spec) {
  BuiltScene scene = kind_of(spec).build(spec);
  round_to_single(scene.system.start);
  round_to_single(scene.system.floor.height);
  return scene;
}

System build_system(const SceneSpec& spec) { return build_scene(spec).system; }

}  // namespace mssim
