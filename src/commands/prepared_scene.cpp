#include "commands/prepared_scene.h"

#include "integrators/stability.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"

namespace mssim {

PreparedScene prepare_scene(std::string_view name_or_file) {
  PreparedScene scene;
  scene.spec = find_scene(name_or_file);
  scene.system = build_system(scene.spec);
  scene.dt_s = scene.spec.dt_s ? *scene.spec.dt_s : auto_dt(stiffness_bound(scene.system));
  return scene;
}

}  // namespace mssim
