#pragma once

#include "garment/body/body_profile.h"
#include "geometry/surface.h"

namespace mssim {

/// A body that has been read, or made, and measured.
struct MeasuredBody {
  Surface surface;      ///< all of it, m, as it is drawn
  BodyProfile profile;  ///< of trunk and legs, which patterns are cut for and garments meet
};

}  // namespace mssim
