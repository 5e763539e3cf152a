#pragma once

#include <string>

#include "garment/body/body_profile.h"
#include "geometry/surface.h"

namespace mssim {

/// A body that has been read, or made, and measured.
struct MeasuredBody {
  Surface surface;      ///< all of it, m, as it is drawn
  std::string note;     ///< what a reader should know of how it was read, in a sentence; or empty
  BodyProfile profile;  ///< of trunk and legs, which patterns are cut for and garments meet
};

}  // namespace mssim
