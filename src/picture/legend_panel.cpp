#include "picture/legend_panel.h"

#include <algorithm>
#include <cmath>

namespace mssim {

LegendSizes::LegendSizes(const Picture& picture) : letters{letter_size_for(picture.height), Rgb{32, 34, 40}} {
  padding = static_cast<int>(std::lround(0.6 * letters.size_px));
  margin = padding;
  const int around = 2 * (padding + margin);
  most_width = std::max(0, static_cast<int>(0.45 * picture.width) - around);
  most_height = std::max(0, static_cast<int>(0.8 * picture.height) - around);
}

PixelBox draw_panel(Picture& picture, int content_width, int content_height, Corner corner) {
  constexpr Rgb edge{190, 193, 200};
  constexpr std::uint8_t coverage = 225;
  const LegendSizes sizes(picture);
  const int width = content_width + 2 * sizes.padding, height = content_height + 2 * sizes.padding;
  const bool at_right = corner == Corner::top_right || corner == Corner::bottom_right;
  const bool at_bottom = corner == Corner::bottom_left || corner == Corner::bottom_right;
  const int left = at_right ? static_cast<int>(picture.width) - sizes.margin - width : sizes.margin;
  const int top = at_bottom ? static_cast<int>(picture.height) - sizes.margin - height : sizes.margin;
  fill(picture, {left, top, width, height}, white, coverage);
  fill(picture, {left, top, width, 1}, edge);
  fill(picture, {left, top + height - 1, width, 1}, edge);
  fill(picture, {left, top + 1, 1, height - 2}, edge);
  fill(picture, {left + width - 1, top + 1, 1, height - 2}, edge);
  return {left + sizes.padding, top + sizes.padding, content_width, content_height};
}

}  // namespace mssim
