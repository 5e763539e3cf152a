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

/// A box, sphere or torus whose surface and inner points mssim makes itself.
template <class Solid>
struct GeneratedShape {
  Solid solid;
  InteriorPoints interior;

  bool operator==(const GeneratedShape&) const = default;
};

/// TetGen's files. Paths that are not absolute start at the scene file's folder.
struct MeshFiles {
  std::string node_file;
  std::string ele_file;
  double unit_m = 1;  ///< metres in one unit of the files

  bool operator==(const MeshFiles&) const = default;
};

/// A closed surface in an OBJ or STL file, to be filled with tetrahedra. Paths that are not absolute start at
/// the scene file's folder.
struct SurfaceFile {
  std::string file;
  double unit_m = 1;                  ///< metres in one unit of the file
  double largest_tetrahedron_m3 = 0;  ///< volume of the largest one allowed, 0 for no limit

  bool operator==(const SurfaceFile&) const = default;
};

/// The first body's shape of another scene: of that name, or of the file with that path, which, if not
/// absolute, starts at the scene file's folder.
struct ShapeOfScene {
  std::string name;

  bool operator==(const ShapeOfScene&) const = default;
};

/// One alternative a kind of shape, in the order of their table (scene/bodies.cpp).
using BodyShape = std::variant<GeneratedShape<BoxShape>, GeneratedShape<SphereShape>,
                               GeneratedShape<TorusShape>, MeshFiles, SurfaceFile, ShapeOfScene>;

/// One body: its shape, and how it starts.
struct BodySpec {
  BodyShape shape;
  std::optional<MeshSize> expected;
  Vec3d centre_m;            ///< of mass
  Vec3d turn_axis{0, 1, 0};  ///< any length but zero
  double turn_deg = 0;       ///< by which the shape is turned about its centre
  Vec3d velocity_m_per_s;    ///< of the centre
  Vec3d spin_rad_per_s;      ///< angular velocity about the centre
  /// Rate at which the body grows at first, so that every spring works from the first step on: a node at the
  /// distance r from the centre starts with swell * r outwards.
  double swell_per_s = 0;
};

/// Solid bodies, all of one material, that start apart from each other and fall.
struct BodiesSpec {
  double density_kg_per_m3 = 0;  ///< a body's mass is spread evenly over its nodes
  SpringMaterial springs;
  std::vector<BodySpec> list;
};

/// The nodes of a cloth that stay where they start: of one row every `every_columns`-th, and its last one.
struct ClothPins {
  std::uint32_t row = 0;
  std::uint32_t every_columns = 1;
};

/// A standing wave at the start of a cloth, so that every spring works from the first step on.
struct ClothRipple {
  double height_m = 0;  ///< amplitude of the vertical displacement; in the plane it is half of that
  double wavelength_m = 1;
  double speed_m_per_s = 0;  ///< amplitude of every component of the velocity
};

/// A regular cloth that hangs by some nodes of one row from the ceiling, level at first. Row r, column c
/// starts at (c spacing, ceiling height, r spacing), plus the ripple.
struct ClothSpec {
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  double spacing_m = 0;
  double areal_density_kg_per_m2 = 0;  ///< a node weighs areal density times spacing squared
  double ceiling_height_m = 0;

  std::optional<ClothPins> pins;  ///< none: the cloth falls freely

  ClothRipple ripple;
  std::array<SpringMaterial, grid_spring_kinds.size()> springs;  ///< by GridSpringKind
};

/// A scene as its file describes it.
struct SceneSpec {
  std::string name;            ///< the file's name without .json, escaped() where it has to be
  std::string description;     ///< one line
  std::optional<double> dt_s;  ///< empty: `auto`, from the stability limit
  double gravity_m_per_s2 = 0;
  double viscous_damping_per_s = 0;
  Floor floor;
  SolverSettings solver;
  std::variant<ClothSpec, BodiesSpec, GarmentSpec>
      content;                 ///< one alternative a scene kind, in the order of their table (scene_kinds.h)
  std::string source;          ///< the file's text, for traces and hashes
  std::filesystem::path file;  ///< where it was read, for messages
};

/// The size of a scene as the tables state it.
struct SceneCounts {
  std::uint64_t nodes = 0;
  std::uint64_t springs_unique = 0;  ///< each spring once
  /// As Hong et al. count them; how, depends on the scene kind. None for a kind that they do not have.
  std::optional<std::uint64_t> springs_published = {};
};

/// What a scene's file describes.
struct BuiltScene {
  System system;
  std::string note = {};  ///< what a reader should know of what it was built from, in a sentence; or empty
  std::shared_ptr<const MeasuredBody> body = {};  ///< that a garment is put on; none of other scenes
};

/// What a scene is built from. All files that its own file names have been read, each once, and made into
/// meshes, or into a measured body and the garment that is cut for it; none is read again.
///
/// Copies share the meshes, of which there is one each. Estimates of memory do not count them: who has built
/// the scene for the last time drops its parts.
struct SceneParts {
  SceneCounts counts;                 ///< what the scene has
  std::optional<SceneCounts> stated;  ///< what files say about that, none where they say nothing
  /// Builds the scene, whose spec they were read for. Throws SceneError for what does not fit together.
  std::function<BuiltScene(const SceneSpec& spec)> build;
};

class FieldVisitor;

/// A kind of scene: all that is asked of it. Rows stand beside what they describe, in scene/cloth.cpp,
/// scene/bodies.cpp and garment/scene/garment_scene.cpp.
struct SceneKind {
  std::string_view name;         ///< value of the file's `kind`, and the key of the section that describes it
  std::string_view description;  ///< of that section, in the schema
  /// Names the section's fields, with their targets in spec.content, which it sets to its alternative. The
  /// functions below need a spec of this alternative.
  void (*visit_fields)(FieldVisitor& fields, SceneSpec& spec);
  /// Checks what one field alone cannot show. Throws SceneError.
  void (*check)(const SceneSpec& spec);
  /// How often a spring is counted in Hong et al.'s tables, by inference from their numbers; none for a kind
  /// that they do not have.
  std::optional<std::uint64_t> published_per_spring;
  /// The files that the section names, as it does; they start at the scene file's folder.
  std::vector<std::string> (*files)(const SceneSpec& spec);
  /// What the file says about nodes and unique springs, none where it says nothing.
  std::optional<SceneCounts> (*stated)(const SceneSpec& spec);
  /// Reads the files that it names. Throws SceneError and MissingProgram.
  SceneParts (*read)(const SceneSpec& spec);
};

}  // namespace mssim
