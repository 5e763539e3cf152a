#pragma once

#include <optional>
#include <string>
#include <variant>

#include "garment/body/body_profile.h"
#include "garment/pattern/garment_build.h"
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

/// What a scene whose content is a garment holds.
inline const GarmentSpec& garment_of(const SceneSpec& spec) { return std::get<GarmentSpec>(spec.content); }

// The body of a garment scene. All of these but visit_body_fields need a spec whose content is a garment.

/// Names the fields of the body, with their targets in garment.body.
void visit_body_fields(FieldVisitor& fields, GarmentSpec& garment);

/// That a body from a file looks along a level axis. Throws SceneError.
void check_body(const SceneSpec& spec);

/// The body that the garment is for, upright in y and looking to +z, its openings closed as far as the scene
/// says so. Throws SceneError for one that cannot be read or measured, and for jeans when it is not a
/// person's height.
MeasuredBody measured_body(const SceneSpec& spec);

/// A garment and how far before the body its maps lie, m.
struct FittedGarment {
  GarmentBuild build;
  double body_offset = 0;
};

/// Cuts, sews and places what a garment scene describes. Its cells decide how far before the body its maps
/// lie, which decides how wide jeans are cut: coarse cloth cut for the body itself would be too tight for
/// them. Throws SceneError, which names the panel or seam that does not fit.
FittedGarment cut_and_placed(const SceneSpec& spec, const BodyProfile& profile);

}  // namespace mssim
