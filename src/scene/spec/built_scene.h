#pragma once

#include <string>

#include "model/system.h"

namespace mssim {

/// What a scene's file describes.
struct BuiltScene {
  System system;
  std::string note;  ///< what a reader should know of what it was built from, in a sentence; or empty
};

}  // namespace mssim
