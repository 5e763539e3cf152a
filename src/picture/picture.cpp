#include "picture/picture.h"

#include <algorithm>
#include <cstddef>

namespace mssim {
namespace {

struct PixelRange {
  std::int64_t begin, end;
};

/// Keeps those of `count` pixels from `first` on that lie within 0 to `size`.
PixelRange pixels_inside(std::int64_t first, std::int64_t count, std::int64_t size) {
  return {std::clamp<std::int64_t>(first, 0, size), std::clamp<std::int64_t>(first + count, 0, size)};
}

}  // namespace

Picture::Picture(std::uint32_t w, std::uint32_t h, Rgb colour)
    : width(w), height(h), pixels(std::size_t{w} * h, colour) {}

void blend(Picture& picture, int x, int y, Rgb colour, std::uint8_t coverage) {
  fill(picture, {x, y, 1, 1}, colour, coverage);
}

void fill(Picture& picture, const PixelBox& box, Rgb colour, std::uint8_t coverage) {
  const PixelRange columns = pixels_inside(box.left, box.width, picture.width);
  const PixelRange rows = pixels_inside(box.top, box.height, picture.height);
  for (std::int64_t y = rows.begin; y < rows.end; ++y)
    for (std::int64_t x = columns.begin; x < columns.end; ++x) {
      Rgb& pixel = picture.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
      pixel = blended(pixel, colour, coverage);
    }
}

void paste(Picture& picture, const Picture& pasted, int left, int top) {
  const PixelRange columns = pixels_inside(left, pasted.width, picture.width);
  const PixelRange rows = pixels_inside(top, pasted.height, picture.height);
  if (columns.begin == columns.end) return;
  for (std::int64_t y = rows.begin; y < rows.end; ++y)
    std::copy_n(
        &pasted.at(static_cast<std::uint32_t>(columns.begin - left), static_cast<std::uint32_t>(y - top)),
        columns.end - columns.begin,
        &picture.at(static_cast<std::uint32_t>(columns.begin), static_cast<std::uint32_t>(y)));
}

}  // namespace mssim
