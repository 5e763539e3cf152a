#pragma once

#include "garment/fitting/fit.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// The body of a garment scene, to measure fits against: the mesh of its trunk and legs, which is what
/// garments meet. Throws SceneError.
FitBody fit_body(const SceneSpec& spec);

}  // namespace mssim
