#pragma once

#include <png.h>

#include "picture/picture.h"
#include "tests/support/testing.h"

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

/// A picture with another colour in most pixels, which are hard to compress, and other ones for each `seed`.
inline Picture coloured_picture(std::uint32_t width, std::uint32_t height, unsigned seed) {
  Picture picture(width, height);
  for (unsigned y = 0; y < height; ++y)
    for (unsigned x = 0; x < width; ++x)
      picture.at(x, y) = {static_cast<std::uint8_t>(7 * x + seed),
                          static_cast<std::uint8_t>(5 * y + x * seed),
                          static_cast<std::uint8_t>((x * 2654435761u ^ y * 2246822519u) >> 13)};
  return picture;
}

/// The pixels of a PNG as libpng reads them, which knows no animations.
inline Picture decoded(const std::string& png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  Picture picture;
  if (png_image_begin_read_from_memory(&image, png.data(), png.size())) {
    image.format = PNG_FORMAT_RGB;
    picture = Picture(image.width, image.height);
    png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr);
  }
  EXPECT_EQ(image.warning_or_error, 0u) << image.message;
  png_image_free(&image);
  return picture;
}

}  // namespace mssim
