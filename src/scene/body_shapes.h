#pragma once

#include <filesystem>
#include <optional>

#include "mesh/tet_mesh.h"
#include "scene/fields/fields.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// Names the fields that say what shape a body has: the text `shape` and the section of that name, with their
/// targets in `body`. The TABLE of shapes stands in body_shapes.cpp.
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

}  // namespace mssim
