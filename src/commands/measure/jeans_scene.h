#pragma once

#include <filesystem>
#include <string>

#include "garment/pattern/jeans.h"
#include "garment/spec/garment_spec.h"

namespace mssim {

/// What jeans for a body from a file are made of.
struct MeasuredJeans {
  BodyFile body;  ///< its file as the scene is to name it
  JeansMeasures measures;
  double hip_girth = 0;  ///< m, of the body
};

/// The text of a scene file to start from: jeans4k for this body. Cloth and dressing are that scene's; dt is
/// shorter by as much as the jeans, of as many nodes, are smaller. `file` is where it is to stand. Throws
/// SceneError for what no scene file can hold, such as a name that is no UTF-8.
std::string jeans_scene(const std::filesystem::path& file, const MeasuredJeans& jeans);

}  // namespace mssim
