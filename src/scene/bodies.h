#pragma once

#include <optional>

#include "model/system.h"
#include "scene/field_visitor.h"
#include "scene/scene_spec.h"

namespace mssim {

/// The row "bodies" of the table of scene kinds (scene_kinds.h says what each function is for). All of them
/// but visit_bodies_fields need a spec whose body is a BodiesSpec.

void visit_bodies_fields(FieldVisitor& fields, SceneSpec& spec);

/// Every turn has an axis. Throws SceneError.
void check_bodies(const SceneSpec& spec);

/// The sum over the bodies; none unless all of them state their size.
std::optional<SceneCounts> stated_bodies_counts(const SceneSpec& spec);

/// Meshes every body. springs_published = 3 springs_unique: Hong et al. seem to give the length of their
/// array of packed springs, three values each (an inference: all nine of their counts can be divided by
/// three, and the thirds fit tetrahedral meshes). Throws SceneError and MissingProgram.
SceneCounts bodies_counts(const SceneSpec& spec);

/// The bodies one after the other, each in its mesh's node order, its springs the edges of its tetrahedra at
/// their length in the mesh. A body starts turned, as a rigid body that flies and spins, and grows at its
/// swell rate. Deterministic. Throws SceneError when a body starts below the floor, MeshError and
/// MissingProgram.
System build_bodies(const SceneSpec& spec);

}  // namespace mssim
