#pragma once

#include "fitting/fit.h"
#include "scene/scene_spec.h"

namespace mssim {

/// The body of a garment scene, to measure fits against: its own mesh, and the legs that it has. Throws
/// SceneError.
FitBody fit_body(const SceneSpec& spec);

}  // namespace mssim
