#include "geometry/geometry.h"

#include <array>
#include <charconv>

namespace mssim {

std::string shown(double computed) {
  std::array<char, 32> text;
  constexpr int digits = 12;
  return {text.data(),
          std::to_chars(text.data(), text.data() + text.size(), computed, std::chars_format::general, digits)
              .ptr};
}

std::string place(const Vec3d& point) {
  return "(" + shown(point.x) + ", " + shown(point.y) + ", " + shown(point.z) + ")";
}

}  // namespace mssim
