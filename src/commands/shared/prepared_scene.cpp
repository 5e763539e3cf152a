#include "commands/shared/prepared_scene.h"

#include <iostream>
#include <optional>
#include <utility>
#include <variant>

#include "scene/scene_kinds.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Meshes, and bodies to dress, are what does not follow from a scene's file alone.
std::string difference(const SceneSpec& spec, const SceneCounts& counts,
                       const std::optional<SceneCounts>& stated) {
  if (!stated || (stated->nodes == counts.nodes && stated->springs_unique == counts.springs_unique))
    return "";
  return "the mesh has " + std::to_string(counts.nodes) + " nodes and " +
         std::to_string(counts.springs_unique) + " springs where the scene states " +
         std::to_string(stated->nodes) + " and " + std::to_string(stated->springs_unique) +
         (std::holds_alternative<GarmentSpec>(spec.content)
              ? ": another body, or another pattern, makes other panels; state what they have"
              : ": another TetGen, or another file, makes another mesh");
}

}  // namespace

PreparedScene prepare_scene(SceneSpec spec, const SceneParts& parts) {
  PreparedScene scene;
  scene.spec = std::move(spec);
  BuiltScene built = build_scene(scene.spec, parts);
  scene.system = std::move(built.system);
  scene.body = std::move(built.body);
  scene.counts = counts_of(scene.spec, scene.system);
  scene.note = difference(scene.spec, scene.counts, parts.stated);
  append_sentence(scene.note, built.note);
  scene.dt_s = scene.spec.dt_s ? *scene.spec.dt_s : auto_dt(mode_bound(scene.system));
  return scene;
}

PreparedScene prepare_scene(SceneSpec spec) {
  const SceneParts parts = read_parts(spec);
  return prepare_scene(std::move(spec), parts);
}

ModeBound mode_bound(const System& system) {
  const StiffnessBound bound = stiffness_bound(system);
  return {bound.stiffness, bound.damping, system.viscous_damping};
}

void warn_of_note(const PreparedScene& scene) {
  if (!scene.note.empty()) std::cerr << "mssim: " << scene.spec.name << ": " << scene.note << '\n';
}

}  // namespace mssim
