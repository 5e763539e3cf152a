#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/vec3.h"
#include "mesh/meshing.h"
#include "mesh/shapes.h"
#include "model/spring.h"

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

/// One alternative a kind of shape, in the order of their table (body_shapes.h).
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

}  // namespace mssim
