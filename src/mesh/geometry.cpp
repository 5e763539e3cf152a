#include "mesh/geometry.h"

#include <array>
#include <charconv>

namespace mssim {

std::string decimal(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string place(const Vec3d& point) {
  return "(" + decimal(point.x) + ", " + decimal(point.y) + ", " + decimal(point.z) + ")";
}

}  // namespace mssim
