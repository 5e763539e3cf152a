#pragma once

#include <sstream>
#include <string>

#include "geometry/surface.h"

namespace mssim {

/// The surface as an OBJ file has it, with so many digits: 17 read back the same.
inline std::string obj_text(const Surface& surface, int digits = 9) {
  std::ostringstream text;
  text.precision(digits);
  for (const Vec3d& point : surface.points)
    text << "v " << point.x << ' ' << point.y << ' ' << point.z << '\n';
  for (const auto& [a, b, c] : surface.triangles)
    text << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  return text.str();
}

}  // namespace mssim
