#pragma once

#include <optional>
#include <string>
#include <variant>

#include "garment/body/body_profile.h"
#include "garment/pattern/garment_build.h"
#include "scene/fields/fields.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

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
