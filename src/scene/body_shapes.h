#pragma once

#include <filesystem>

#include "mesh/tet_mesh.h"
#include "scene/fields/field_visitor.h"
#include "scene/spec/bodies_spec.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// Names the fields that say what shape a body has: the text `shape` and the section of that name, with their
/// targets in `body`. The TABLE of shapes stands in body_shapes.cpp.
void visit_shape_fields(FieldVisitor& fields, BodySpec& body);

/// What the scene's file, or the other scene that it names, states about the mesh. `folder` is the scene
/// file's. Throws SceneError when there is no such scene.
std::optional<MeshSize> stated_size(const BodySpec& body, const std::filesystem::path& folder);

/// Nodes and springs that the mesh of the shape has at least, without making it; zero where that is not
/// known. Throws like stated_size.
SceneCounts least_counts(const BodyShape& shape, const std::filesystem::path& folder);

/// The mesh of the shape, m, wherever its origin is. `folder` is the scene file's. Throws SceneError when the
/// shape is that of a scene that cannot be used, InputError and MissingProgram.
TetMesh mesh_of(const BodyShape& shape, const std::filesystem::path& folder);

}  // namespace mssim
