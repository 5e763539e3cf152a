#pragma once

#include <sstream>
#include <string>

#include "geometry/surface.h"

namespace mssim {

/// The surface as an OBJ file has it.
inline std::string obj_text(const Surface& surface) {
  std::ostringstream text;
  text.precision(9);
  for (const Vec3d& point : surface.points)
    text << "v " << point.x << ' ' << point.y << ' ' << point.z << '\n';
  for (const auto& [a, b, c] : surface.triangles)
    text << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  return text.str();
}

}  // namespace mssim
