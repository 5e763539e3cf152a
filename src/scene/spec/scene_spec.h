#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "garment/body/body_profile.h"
#include "garment/spec/garment_spec.h"
#include "geometry/vec3.h"
#include "mesh/meshing.h"
#include "model/system.h"

namespace mssim {

/// TetGen's files. Relative paths are relative to the scene file's folder.
struct MeshFiles {
  std::string node_file;
  std::string ele_file;
  double unit_m = 1;  ///< metres in one unit of the files

  bool operator==(const MeshFiles&) const = default;
};

/// The shape of another scene's first body: the scene's name, or the path of its file, relative to the scene
/// file's folder.
struct ShapeOfScene {
  std::string name;

  bool operator==(const ShapeOfScene&) const = default;
};

/// The shape of a body (scene/bodies.cpp has the table of its kinds). A relative path of a SurfaceFile is
/// relative to the scene file's folder.
using BodyShape = std::variant<GeneratedShape, MeshFiles, SurfaceFile, ShapeOfScene>;

/// One body: its shape and its start.
struct BodySpec {
  BodyShape shape;
  std::optional<MeshSize> expected;
  Vec3d centre_m;            ///< centre of mass
  Vec3d turn_axis{0, 1, 0};  ///< of any nonzero length
  double turn_deg = 0;       ///< rotation of the shape about its centre
  Vec3d velocity_m_per_s;    ///< of the centre
  Vec3d spin_rad_per_s;      ///< angular velocity about the centre
  /// Initial growth rate, so that every spring is active from the first step on: a node at distance r from
  /// the centre starts with swell * r outwards.
  double swell_per_s = 0;
};

struct SceneKind;

/// Solid bodies of one material that start apart from each other and fall.
struct BodiesSpec {
  double density_kg_per_m3 = 0;  ///< the nodes of a body share its mass evenly
  SpringMaterial springs;
  std::vector<BodySpec> list;

  static const SceneKind kind;
};

/// The pinned nodes of a cloth: every `every_columns`-th node of one row, and its last one.
struct ClothPins {
  std::uint32_t row = 0;
  std::uint32_t every_columns = 1;
};

/// A standing wave at the start of a cloth, so that every spring is active from the first step on.
struct ClothRipple {
  double height_m = 0;  ///< amplitude of the vertical displacement; in the plane it is half as large
  double wavelength_m = 1;
  double speed_m_per_s = 0;  ///< amplitude of every component of the velocity
};

/// A regular cloth that hangs from the ceiling by some nodes of one row, horizontal at the start. Row r,
/// column c starts at (c spacing, ceiling height, r spacing), plus the ripple.
struct ClothSpec {
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  double spacing_m = 0;
  double areal_density_kg_per_m2 = 0;  ///< a node weighs areal density times spacing squared
  double ceiling_height_m = 0;

  std::optional<ClothPins> pins;  ///< none: the cloth falls freely

  ClothRipple ripple;
  std::array<SpringMaterial, grid_spring_kinds.size()> springs;  ///< by GridSpringKind

  static const SceneKind kind;
};

/// The content of a scene file.
struct SceneSpec {
  std::string name;            ///< the file's name without .json, escaped() if necessary
  std::string description;     ///< one line
  std::optional<double> dt_s;  ///< empty: `auto`, from the stability limit
  double gravity_m_per_s2 = 0;
  double viscous_damping_per_s = 0;
  Floor floor;
  SolverSettings solver;
  std::variant<ClothSpec, BodiesSpec, GarmentSpec> content;  ///< the TABLE of scene kinds (scene_kinds.h)
  std::string source;                                        ///< the file's text, for traces and hashes
  std::filesystem::path file;                                ///< path for messages
};

/// Gives a system the scene's gravity, damping, floor and solver settings.
inline void set_laws(System& system, const SceneSpec& spec) {
  system.gravity = spec.gravity_m_per_s2;
  system.viscous_damping = spec.viscous_damping_per_s;
  system.floor = spec.floor;
  system.solver = spec.solver;
}

/// The size of a scene as shown in tables.
struct SceneCounts {
  std::uint64_t nodes = 0;
  std::uint64_t springs_unique = 0;  ///< each spring once
  /// As Hong et al. count them, which depends on the scene kind. Nothing for a kind that they do not have.
  std::optional<std::uint64_t> springs_published = {};
};

/// A built scene.
struct BuiltScene {
  System system;
  /// Sentences about its sources, and about sizes that differ from those that its file states; or empty.
  std::string note = {};
  std::shared_ptr<const MeasuredBody> body = {};  ///< the body that wears a garment, or null
};

/// The parts that a scene is built from. All files that its file names have been read, each once, and made
/// into meshes, or into a measured body and the garment cut for it; none is read again.
///
/// Copies share the meshes. Estimates of memory do not count them, so drop the parts after the last build of
/// the scene.
struct SceneParts {
  SceneCounts counts;  ///< nodes and springs of the scene
  /// Builds the scene for whose spec they were read. Throws SceneError for inconsistent content.
  std::function<BuiltScene(const SceneSpec& spec)> build;
  std::vector<std::filesystem::path> files = {};  ///< all that were read, with the scene's own
  /// Hash of the meshes or of the body that the files made; nothing if the scene file names none.
  std::optional<std::uint64_t> files_fnv1a_64 = {};
};

class FieldVisitor;

/// A kind of scene and its operations: the member `kind` of its spec, defined in the file with its builder.
struct SceneKind {
  std::string_view name;         ///< value of the file's `kind`, and the key of its section
  std::string_view description;  ///< description of the section in the schema
  /// Names the section's fields, with their targets in spec.content, which it first sets to its alternative.
  /// The functions below need a spec of this alternative.
  void (*visit_fields)(FieldVisitor& fields, SceneSpec& spec);
  /// Checks what no single field shows. Throws SceneError.
  void (*check)(const SceneSpec& spec);
  /// Counts per spring in Hong et al.'s tables, inferred from their numbers; nothing for a kind that they do
  /// not have.
  std::optional<std::uint64_t> published_per_spring;
  /// Nodes and unique springs that the file states; nothing if it states none.
  std::optional<SceneCounts> (*stated)(const SceneSpec& spec);
  /// Reads the files that the section names, and lists them. Throws SceneError and MissingProgram.
  SceneParts (*read)(const SceneSpec& spec);
};

}  // namespace mssim
