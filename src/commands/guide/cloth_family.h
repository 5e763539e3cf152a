#pragma once

#include "guide/cloth_sizes.h"
#include "scene/spec/scene_spec.h"

namespace mssim {

/// Makes square cloths of the same springs, masses, spacing, pins and ripple as this one, which hang as high
/// above the floor as it does in lengths of a side. None where the scene is no cloth.
ClothMaker cloth_family(const SceneSpec& spec);

/// Whether both are cloths of one family: the same but for their size.
bool same_family(const SceneSpec& a, const SceneSpec& b);

}  // namespace mssim
