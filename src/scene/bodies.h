#pragma once

#include <optional>

#include "scene/fields/fields.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// The row "bodies" of the table of scene kinds (scene_kinds.h says what each function is for). All of them
/// but visit_bodies_fields need a spec whose body is a BodiesSpec.

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
