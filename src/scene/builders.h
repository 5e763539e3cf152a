#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "mesh/meshing.h"
#include "model/system.h"
#include "scene/fields/fields.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// The row "cloth" of the table of scene kinds (scene_kinds.h says what each function is for). All of them
/// but visit_cloth_fields need a spec whose content is a ClothSpec.

void visit_cloth_fields(FieldVisitor& fields, SceneSpec& spec);

/// The nodes can be numbered, the pinned row exists, the cloth starts above the floor, and the ripple folds
/// no spring to length zero. Throws SceneError.
void check_cloth(const SceneSpec& spec);

/// A cloth is as its file says.
std::optional<SceneCounts> stated_cloth_counts(const SceneSpec& spec);

/// There is nothing to read: a cloth names no files.
SceneParts read_cloth(const SceneSpec& spec);

/// The nodes of a window as a cloth of their own, with the numbers that they have in the whole: what lies
/// outside is not built. Its springs are left out: springs_of (model/system.h) gives them. Throws
/// std::bad_alloc.
System build_cloth_window(const SceneSpec& spec, const GridWindow& window);

/// What can be known of the cloth without any of its nodes: all but their masses, pins, springs and start.
System outline_of_cloth(const SceneSpec& spec);

/// The cloth as spec describes it: node (r, c) has the index r * columns + c and starts at
/// (c spacing, ceiling height, r spacing) plus the ripple, a standing wave of given amplitude in position and
/// velocity. Pinned nodes are not displaced. Deterministic. Throws SceneError when the memory does not
/// suffice.
System build_cloth(const SceneSpec& spec);

/// Names the fields that say what shape a body has: the text `shape` and the section of that name, with their
/// targets in `body`.
void visit_shape_fields(FieldVisitor& fields, BodySpec& body);

/// A shape that is not that of another scene any more.
struct OwnShape {
  BodyShape shape;
  std::filesystem::path folder;             ///< that the paths of its files start at
  std::optional<MeshSize> stated_by_other;  ///< about the mesh, by the scene that it was taken from
};

/// The shape of a body in a scene file of that folder; where it is another scene's, that is read. Throws
/// SceneError when there is no such scene, or it cannot be used.
OwnShape own_shape(const BodyShape& shape, const std::filesystem::path& folder);

/// What files state about the mesh of a body of that shape.
std::optional<MeshSize> stated_size(const BodySpec& body, const OwnShape& shape);

/// Nodes and springs that the mesh of the shape has at least, without making it; zero where that is not
/// known.
SceneCounts least_counts(const OwnShape& shape);

/// The mesh of the shape, m, wherever its origin is. Throws InputError and MissingProgram.
TetMesh mesh_of(const OwnShape& shape);

/// The row "bodies" of the table of scene kinds (scene_kinds.h says what each function is for). All of them
/// but visit_bodies_fields need a spec whose content is a BodiesSpec.

void visit_bodies_fields(FieldVisitor& fields, SceneSpec& spec);

/// Every turn has an axis. Throws SceneError.
void check_bodies(const SceneSpec& spec);

/// The sum over the bodies; none unless all of them state their size.
std::optional<SceneCounts> stated_bodies_counts(const SceneSpec& spec);

/// Meshes every shape once.
///
/// The scene has the bodies one after the other, each in its mesh's node order, its springs the edges of its
/// tetrahedra at their length in the mesh. A body starts turned, as a rigid body that flies and spins, and
/// grows at its swell rate. Deterministic. Throws SceneError when a body has no mesh and when the memory does
/// not suffice for the meshes, and MissingProgram; building it throws SceneError when a body starts below the
/// floor.
SceneParts read_bodies(const SceneSpec& spec);

}  // namespace mssim
