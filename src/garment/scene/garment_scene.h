#pragma once

#include <optional>

#include "scene/fields/fields.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// The row "garment" of the table of scene kinds (scene_kinds.h says what each function is for). All of them
/// but visit_garment_fields need a spec whose content is a GarmentSpec.

void visit_garment_fields(FieldVisitor& fields, SceneSpec& spec);

/// That the pieces have names, curves and not too many nodes. Throws SceneError.
void check_garment(const SceneSpec& spec);

std::optional<SceneCounts> stated_garment_counts(const SceneSpec& spec);

/// Measures the body and cuts the garment for it. Throws SceneError when the body cannot be measured or the
/// pattern does not fit together.
///
/// The scene has the panels placed around the body, at rest, and the maps of the body that they collide with;
/// its note says what of the body they ignore. Deterministic. Building it throws SceneError when the garment
/// starts below the floor or the memory does not suffice.
SceneParts read_garment(const SceneSpec& spec);

}  // namespace mssim
