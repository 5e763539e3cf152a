#pragma once

#include <memory>
#include <string>

#include "garment/body/measured_body.h"
#include "model/system.h"

namespace mssim {

/// What a scene's file describes.
struct BuiltScene {
  System system;
  std::string note = {};  ///< what a reader should know of what it was built from, in a sentence; or empty
  std::shared_ptr<const MeasuredBody> body = {};  ///< that a garment is put on; none of other scenes
};

}  // namespace mssim
