#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "picture/picture.h"

namespace mssim {

/// The colour that tests draw on, which is none of those that are drawn.
inline constexpr Rgb ground{90, 120, 60};

/// The smallest box that has all pixels for which `wanted` holds; none if there is none.
template <class Wanted>
std::optional<PixelBox> box_of(const Picture& picture, const Wanted& wanted) {
  int left = static_cast<int>(picture.width), top = static_cast<int>(picture.height), right = 0, bottom = 0;
  for (std::uint32_t y = 0; y < picture.height; ++y)
    for (std::uint32_t x = 0; x < picture.width; ++x)
      if (wanted(picture.at(x, y))) {
        left = std::min(left, static_cast<int>(x));
        right = std::max(right, static_cast<int>(x) + 1);
        top = std::min(top, static_cast<int>(y));
        bottom = std::max(bottom, static_cast<int>(y) + 1);
      }
  if (right == 0) return std::nullopt;
  return PixelBox{left, top, right - left, bottom - top};
}

/// The smallest box that has all pixels that are not `background`.
inline std::optional<PixelBox> ink_of(const Picture& picture, Rgb background = white) {
  return box_of(picture, [&](Rgb pixel) { return pixel != background; });
}

/// The smallest box that has all pixels of one colour.
inline std::optional<PixelBox> box_of_colour(const Picture& picture, Rgb colour) {
  return box_of(picture, [&](Rgb pixel) { return pixel == colour; });
}

}  // namespace mssim
