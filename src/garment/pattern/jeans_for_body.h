#pragma once

#include "garment/body/landmarks.h"
#include "garment/pattern/jeans_outline.h"

namespace mssim {

/// Measures of jeans for a body, in whole millimetres, but for what the body itself says when they are
/// drafted (its girth, crotch and offset): worn as those of the reference body are, with their upper edge a
/// fifth of the way below the waist and legs that are wider than the body's at every height.
JeansMeasures jeans_for_body(const BodyProfile& profile, const BodyLandmarks& body);

}  // namespace mssim
