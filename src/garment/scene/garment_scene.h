#pragma once

#include <optional>

#include "scene/fields/field_visitor.h"
#include "scene/spec/built_scene.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// The row "garment" of the table of scene kinds (scene_kinds.h says what each function is for). All of them
/// but visit_garment_fields need a spec whose body is a GarmentSpec.

void visit_garment_fields(FieldVisitor& fields, SceneSpec& spec);

/// That the pieces have names, curves and not too many nodes. Throws SceneError.
void check_garment(const SceneSpec& spec);

std::optional<SceneCounts> stated_garment_counts(const SceneSpec& spec);

/// Measures the body and drafts the pattern. Throws SceneError.
SceneCounts garment_counts(const SceneSpec& spec);

/// Panels placed around the body, at rest, and the maps of the body that they collide with; the note says
/// what of the body they ignore. Deterministic. Throws SceneError when the body cannot be measured, the
/// pattern does not fit together or the memory does not suffice.
BuiltScene build_garment_scene(const SceneSpec& spec);

}  // namespace mssim
