// Scene files: the text, the counts that it states, and the System of small scenes.

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "fuzz_checks.h"
#include "scene/fields/fields.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"

namespace mssim {
namespace {

/// Where a scene's own mesh files would lie: this folder, which has tetrahedra.node and tetrahedra.ele.
const std::filesystem::path scene_path = std::filesystem::path(MSSIM_FUZZ_FOLDER) / "fuzz.json";

/// An unknown name has all scenes read to list them, which takes too long.
bool is_cheap_name(const std::string& name) { return name == "box-small" || is_path_of_scene(name); }

/// A garment as coarse as one can be that still has all its parts; of any other scene nothing changes.
void make_coarse(SceneSpec& spec) {
  auto* const garment = std::get_if<GarmentSpec>(&spec.content);
  if (garment == nullptr) return;
  constexpr std::uint32_t jeans_nodes = 300, most_rows = 9;
  if (auto* const form = std::get_if<MannequinBody>(&garment->body)) {
    form->cells_around = std::min(form->cells_around, 16U);
    garment->pixel_m = std::max(garment->pixel_m, form->measures.bust.height / 60);
  }
  if (garment->jeans) garment->jeans->nodes = std::min(garment->jeans->nodes, jeans_nodes);
  if (!garment->pieces) return;
  for (PieceSpec& piece : garment->pieces->panels) {
    piece.grid.rows = std::min(piece.grid.rows, most_rows);
    piece.grid.columns = std::min(piece.grid.columns, most_rows);
  }
}

/// No shape has to be meshed by TetGen that is not small, and no body has to be read from a file.
bool may_count(const SceneSpec& spec) {
  if (const auto* garment = std::get_if<GarmentSpec>(&spec.content))
    return std::holds_alternative<MannequinBody>(garment->body);
  const auto* bodies = std::get_if<BodiesSpec>(&spec.content);
  if (bodies == nullptr) return true;
  constexpr std::size_t most_bodies = 8;
  return bodies->list.size() <= most_bodies &&
         std::all_of(bodies->list.begin(), bodies->list.end(), [](const BodySpec& body) {
           const auto* other = std::get_if<ShapeOfScene>(&body.shape);
           return other == nullptr || is_cheap_name(other->name);
         });
}

/// Small, and without a run of TetGen.
bool may_build(const SceneSpec& spec) {
  constexpr std::uint64_t most_nodes = 100;
  if (std::holds_alternative<GarmentSpec>(spec.content)) return true;
  const auto* bodies = std::get_if<BodiesSpec>(&spec.content);
  if (bodies == nullptr) return counts_of(spec).nodes <= most_nodes;
  return std::all_of(bodies->list.begin(), bodies->list.end(),
                     [](const BodySpec& body) { return std::holds_alternative<MeshFiles>(body.shape); });
}

bool is_positive(double value) { return std::isfinite(value) && value > 0; }

void check(const System& system) {
  const std::size_t nodes = system.nodes();
  require(nodes > 0 && system.start.velocity.size() == nodes && system.node_mass.size() == nodes,
          "every node has a place, a velocity and a mass");
  for (std::size_t node = 0; node < nodes; ++node) {
    require(is_finite(system.start.position[node]) && is_finite(system.start.velocity[node]),
            "starts are finite");
    require(system.start.position[node].y >= system.floor.height, "no node starts below the floor");
    // Backends compute in single precision.
    require(is_positive(static_cast<float>(system.node_mass[node])), "nodes have a mass");
  }
  for (const Spring& spring : system.springs) {
    require(spring.first < nodes && spring.second < nodes && spring.kind < system.materials.size(),
            "springs join nodes");
    require(is_positive(spring.rest_length), "springs have a length");
    require(system.start.position[spring.first] != system.start.position[spring.second],
            "a spring's ends stand apart");
  }
  require(std::is_sorted(system.pins.begin(), system.pins.end()), "pins ascend");
  for (const std::uint32_t pin : system.pins)
    require(pin < nodes && system.start.velocity[pin] == Vec3d{}, "pins are nodes at rest");
  const ModeBound bound = mode_bound(system);
  require(is_positive(bound.stiffness) && std::isfinite(bound.damping), "the stability limit can be found");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto spec =
      unless_refused<SceneError>([&] { return parse_scene(scene_path, std::string(text_of(data, size))); });
  if (!spec || !may_count(*spec)) return 0;
  make_coarse(*spec);
  require(!spec->dt_s || is_positive(*spec->dt_s), "steps have a length");
  const auto stated = unless_refused<SceneError>([&] { return stated_counts(*spec); });
  if (!stated || !may_build(*spec)) return 0;
  const auto system = unless_refused<SceneError>([&] { return build_system(*spec); });
  if (!system) return 0;
  check(*system);
  if (std::holds_alternative<ClothSpec>(spec->content))
    require(
        *stated && (*stated)->nodes == system->nodes() && (*stated)->springs_unique == system->springs.size(),
        "a cloth has the counts that its file states");
  return 0;
}

}  // namespace mssim
