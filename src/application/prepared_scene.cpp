#include "application/prepared_scene.h"

#include <algorithm>
#include <exception>
#include <set>
#include <span>
#include <utility>

#include "application/console.h"
#include "bench/verification/verification.h"
#include "garment/contact/solid.h"
#include "garment/stepping/dressing_backend.h"
#include "integrators/stability.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// The axes around all of which a row of cloth with this middle must go: that of the leg on its side, those
/// of both legs, or that of the trunk.
std::vector<Vec3d> limb_axes(const BodyProfile& profile, const Vec3d& middle) {
  // Between the legs, front and back of trousers nearly touch up to this height above the crotch. The middle
  // of the trunk need not lie between them.
  constexpr double fork = 0.1;  // m
  const auto at = [&](const PlanPoint& axis) { return Vec3d{axis.x, middle.y, axis.z}; };
  if (profile.has_legs() && profile.legs_are_apart(middle.y)) {
    const Vec3d right = at(profile.leg_middle(middle.y, -1)), left = at(profile.leg_middle(middle.y, 1));
    if (middle.x < right.x / 2) return {right};
    if (middle.x > left.x / 2) return {left};
    if (middle.y < profile.crotch_height() + fork) return {right, left};
  }
  return {at(profile.middle(std::clamp(middle.y, profile.lowest(), profile.highest())))};
}

}  // namespace

PreparedScene prepare_scene(SceneSpec spec, const SceneParts& parts) {
  PreparedScene scene;
  scene.spec = std::move(spec);
  BuiltScene built = build_scene(scene.spec, parts);
  scene.system = std::move(built.system);
  scene.body = std::move(built.body);
  scene.files = parts.files;
  scene.counts = parts.counts;
  scene.note = std::move(built.note);
  const bool is_garment = scene.body != nullptr;
  scene.dt_s = scene.spec.dt_s ? *scene.spec.dt_s
                               : auto_dt(mode_bound(scene.system), [&](const Integrator& integrator) {
                                   return !is_garment || dresses(integrator);
                                 });
  return scene;
}

PreparedScene prepare_scene(SceneSpec spec) {
  const SceneParts parts = read_parts(spec);
  return prepare_scene(std::move(spec), parts);
}

void require_distinct_names(const std::vector<SceneSpec>& scenes) {
  for (auto scene = scenes.begin(); scene != scenes.end(); ++scene)
    for (auto other = scenes.begin(); other != scene; ++other)
      if (other->name == scene->name)
        throw UsageError("there are two scenes called {}, {} and {}; name one of them, or rename a file",
                         printable(scene->name), printable(other->file.string()),
                         printable(scene->file.string()));
}

void warn_of_note(const PreparedScene& scene) {
  if (!scene.note.empty()) tell("{}: {}", scene.spec.name, scene.note);
}

void mark_own_scenes(std::vector<ResultRow>& rows, const Provenance& measured) {
  const auto is_shipped = [](const SceneHash& scene) {
    try {
      // A path would be read as the user's own file.
      return !is_path_of_scene(scene.name) && is_scene(scene.name) &&
             scene.fnv1a_64 == fnv1a_64(find_scene(scene.name).source);
    } catch (const std::exception&) {
      return false;  // not a readable scene
    }
  };
  std::set<std::string> shipped;
  for (const SceneHash& scene : measured.scenes)
    if (is_shipped(scene)) shipped.insert(scene.name);
  for (ResultRow& row : rows) {
    row.scene_as_shipped = shipped.contains(row.scene);
    if (!row.scene_as_shipped) row.paper_ms.reset();
  }
}

FitBody fit_body(const std::shared_ptr<const MeasuredBody>& body) {
  // The part that the garment touches: an arm next to the hip must not count as the body's inside.
  const auto solid = std::make_shared<const Solid>(body->profile.trunk_and_legs().surface);
  // Cutting a hand off also removes part of the hip: cloth inside the whole body does not stand off.
  const auto whole = std::make_shared<const Solid>(body->surface);
  return {[solid](std::span<const Vec3d> points) { return solid->depths(points); },
          [body](const Vec3d& middle) { return limb_axes(body->profile, middle); },
          [whole, body](std::span<const Vec3d> points, double lowest, double highest) {
            const BandHull hull(body->profile.trunk_and_legs().surface, lowest, highest);
            std::vector<double> distances;
            for (const Vec3d& point : points)
              distances.push_back(
                  whole->depth(point) > 0 ? 0 : std::min(whole->distance(point), hull.distance(point)));
            return distances;
          }};
}

}  // namespace mssim
