#pragma once

#include <string>

#include "garment/body/body_profile.h"
#include "garment/pattern/garment_build.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// A garment and how far before the body its maps lie, m.
struct FittedGarment {
  GarmentBuild build;
  double body_offset = 0;
};

/// Cuts, sews and places what a garment scene describes. Its cells decide how far before the body its maps
/// lie, which decides how wide jeans are cut: coarse cloth cut for the body itself would be too tight for
/// them. Throws SceneError, which names the panel or seam that does not fit.
FittedGarment cut_and_placed(const SceneSpec& spec, const BodyProfile& profile);

/// The place in its scene file at which a garment describes its pieces.
std::string pieces_pointer(const GarmentSpec& garment);

}  // namespace mssim
