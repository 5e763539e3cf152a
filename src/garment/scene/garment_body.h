#pragma once

#include <variant>

#include "garment/body/body_profile.h"
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

}  // namespace mssim
