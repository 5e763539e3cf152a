#pragma once

#include "garment/body/body_profile.h"
#include "garment/pattern/garment_build.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

// All functions need a spec whose content is a garment.

/// The body that wears the garment, upright in y and facing +z, with openings closed as the scene specifies.
/// Throws SceneError if it cannot be read or measured, and for jeans if its height is not a person's.
MeasuredBody measured_body(const SceneSpec& spec);

/// A garment (build_garment), and the distance of its maps from the body, m.
struct FittedGarment {
  System system;
  double body_offset = 0;
};

/// Cuts, sews and places the garment of a scene. The size of its cells determines the distance of the maps
/// from the body, and so the width of jeans: coarse cloth cut for the body itself would be too tight for the
/// maps. Throws SceneError, which names the panel or seam that does not fit.
FittedGarment cut_and_placed(const SceneSpec& spec, const BodyProfile& profile);

}  // namespace mssim
