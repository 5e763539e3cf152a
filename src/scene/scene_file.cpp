#include "scene/scene_file.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "platform/files.h"
#include "scene/fields/fields.h"
#include "scene/scene_kinds.h"
#include "text/text.h"

namespace mssim {
namespace {

std::filesystem::path scene_folder() { return data_folder() / "scenes"; }

std::filesystem::path file_of(std::string_view name) {
  return scene_folder() / (std::string(name) + ".json");
}

/// Unordered. The schema next to the scenes, scene.schema.json, is excluded.
std::vector<std::string> names_in_folder() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(scene_folder())) {
    const std::filesystem::path& file = entry.path();
    if (file.extension() == ".json" && file.stem().extension() != ".schema")
      names.push_back(file.stem().string());
  }
  return names;
}

/// Names the fields of a whole scene file, with their targets in `spec`.
void visit_scene_fields(FieldVisitor& fields, SceneSpec& spec) {
  std::string schema;  // for editors; not part of the scene
  fields.text({"$schema", "Path of this schema, for editors; mssim ignores it."}, Presence::optional, schema);
  std::vector<Section> kinds;
  for (const SceneKind* kind : scene_kinds())
    kinds.push_back(
        {{kind->name, kind->description}, [&, kind](FieldVisitor& body) { kind->visit_fields(body, spec); }});
  fields.one_of({"kind", "The scene kind; also the key of the section with its content."}, kinds);
  fields.text({"description", "One line for listings."}, Presence::required, spec.description);
  fields.number_or_auto(
      {"dt_s",
       "Length of a time step, s; \"auto\" is half of the smallest stability limit of those "
       "integrators of Hong et al. that can step the scene."},
      spec.dt_s, from(1e-12, 1));
  fields.number({"gravity_m_per_s2", "Gravitational acceleration, downwards, m/s^2."}, spec.gravity_m_per_s2,
                from(0, 1000));
  fields.number(
      {"viscous_damping_per_s", "Deceleration of every node per speed, 1/s: a = -viscous_damping v."},
      spec.viscous_damping_per_s, from(0, 1e6));
  fields.object(
      {"floor",
       "The plane y = height, which stops falling nodes. It acts once per step, after the integrator: for a "
       "free node below it, y becomes the height, a falling v_y becomes -restitution * v_y, and the "
       "horizontal speed decreases by friction * (1 + restitution) * |v_y|, at most to zero. With verlet, "
       "the positions meet it that its forces see, half a step ahead."},
      Presence::required, [&floor = spec.floor](FieldVisitor& section) {
        section.number({"height_m", "Height of the floor, m."}, floor.height, from(-1e6, 1e6));
        section.number({"restitution", "Fraction of the falling speed that is reversed, dimensionless."},
                       floor.restitution, from(0, 1));
        section.number({"friction", "Coulomb's friction coefficient, dimensionless."}, floor.friction,
                       from(0, 100));
      });
  fields.object(
      {"implicit",
       "Accuracy of the solvers of implicit integrators (default: tolerance 1e-5, 10 iterations, 10 "
       "substeps)."},
      Presence::optional, [&solver = spec.solver](FieldVisitor& section) {
        section.number(
            {"tolerance",
             "Relative tolerance of implicit-euler's linear system and of newton-euler's change of "
             "velocities."},
            solver.tolerance, above(0, 0.1));
        section.integer({"fast_springs_iterations", "Local and global steps of fast-springs per step."},
                        solver.iterations, 1, 10000);
        section.integer({"xpbd_substeps", "Substeps of xpbd per step."}, solver.substeps, 1, 1000);
      });
}

std::string_view remedy_of(ReadError::Cause cause) {
  switch (cause) {
    case ReadError::Cause::missing:
      return "check the path, or name a scene of `mssim list scenes`";
    case ReadError::Cause::too_large:
      return "give a scene file, which takes a few kilobytes";
    default:
      return "give the path of a scene file";
  }
}

std::string text_of(const std::filesystem::path& file) {
  try {
    return read_file(file, largest_scene_bytes);
  } catch (const ReadError& error) {
    throw SceneError(error.sentence(file, remedy_of(error.cause)));
  }
}

}  // namespace

std::string scene_schema() {
  SceneSpec unused;
  return json_schema(
      "Scene of mssim",
      "A mass-spring scene: time step, forces, and content. SI units, stated in the keys; "
      "y points up. mssim also checks that the fields are consistent: the pinned row exists, cloth and "
      "bodies start above the floor, the ripple is at most a tenth of its wavelength and, if there are "
      "pins, at most the spacing high, and meshes are valid.",
      [&](FieldVisitor& fields) { visit_scene_fields(fields, unused); });
}

SceneSpec parse_scene(const std::filesystem::path& file, std::string text) {
  SceneSpec spec;
  read_fields(file, text, [&](FieldVisitor& fields) { visit_scene_fields(fields, spec); });
  spec.name = escaped(file.stem().string());
  spec.file = file;
  spec.source = std::move(text);
  kind_of(spec).check(spec);
  return spec;
}

SceneSpec load_scene(const std::filesystem::path& file) { return parse_scene(file, text_of(file)); }

std::vector<SceneSpec> shipped_scenes() {
  using Key = std::tuple<std::size_t, std::uint64_t, std::string>;
  std::vector<std::pair<Key, SceneSpec>> scenes;
  for (std::string& name : names_in_folder()) {
    SceneSpec spec = load_scene(file_of(name));
    Key key(spec.content.index(), stated_counts(spec).value_or(SceneCounts{}).nodes, std::move(name));
    scenes.emplace_back(std::move(key), std::move(spec));
  }
  std::ranges::sort(scenes, {}, &std::pair<Key, SceneSpec>::first);
  std::vector<SceneSpec> specs;
  specs.reserve(scenes.size());
  for (auto& [key, spec] : scenes) specs.push_back(std::move(spec));
  return specs;
}

bool is_path_of_scene(std::string_view name_or_path) {
  return name_or_path.find('/') != std::string_view::npos || name_or_path.ends_with(".json");
}

bool is_scene(std::string_view name_or_path) {
  std::error_code error;  // a name too long for a file is not a file
  if (is_path_of_scene(name_or_path)) return std::filesystem::exists(name_or_path, error);
  const std::vector<std::string> names = names_in_folder();
  return std::find(names.begin(), names.end(), name_or_path) != names.end();
}

SceneSpec find_scene(std::string_view name_or_path) {
  if (is_path_of_scene(name_or_path)) return load_scene(name_or_path);
  if (is_scene(name_or_path)) return load_scene(file_of(name_or_path));
  std::error_code error;  // a name too long for a file is not a file
  if (std::filesystem::is_regular_file(name_or_path, error))
    throw SceneError(
        "\"{0}\" is a file, but not the name of a scene: a scene's file ends in .json, or its path has a "
        "folder, as in ./{0}",
        printable(name_or_path));
  const std::vector<std::string> names = names_in_folder();
  throw SceneError("no scene is named \"" + printable(name_or_path) + '"' +
                   did_you_mean(name_or_path, std::vector<std::string_view>(names.begin(), names.end())) +
                   ": give the path of a scene file, or one of the names that mssim list scenes shows");
}

}  // namespace mssim
