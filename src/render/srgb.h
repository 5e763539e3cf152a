#pragma once

#include "picture/picture.h"
#include "render/subject.h"

namespace mssim {

/// The light of a colour in sRGB (IEC 61966-2-1).
Light light_of(const Rgb& colour);

/// The colour of light in sRGB, what is brighter than white as white.
Rgb colour_of(const Light& light);

}  // namespace mssim
