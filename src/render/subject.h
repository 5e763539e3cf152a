#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/surface.h"
#include "geometry/vec3.h"

namespace mssim {

/// Red, green and blue in linear light, 0 to 1.
using Light = Vec3<float>;

/// What a picture shows at one moment: triangles that need not close, seen from both sides, each point with
/// the colour of what it belongs to.
struct Subject {
  Surface surface;           ///< m; y points up
  std::vector<Light> front;  ///< [points] colour of the side that a triangle is counter-clockwise from
  std::vector<Light> back;   ///< [points] of the other side
};

}  // namespace mssim
