#include "commands/prepared_scene.h"

#include "integrators/stability.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"

namespace mssim {

PreparedScene prepare_scene(std::string_view name_or_file) {
  PreparedScene scene;
  scene.spec = find_scene(name_or_file);
  scene.system = build_system(scene.spec);
  if (scene.spec.dt_s) {
    scene.dt_s = *scene.spec.dt_s;
  } else {
    const StiffnessBound bound = stiffness_bound(scene.system);
    scene.dt_s = auto_dt({bound.stiffness, bound.damping, scene.system.viscous_damping});
  }
  return scene;
}

}  // namespace mssim
