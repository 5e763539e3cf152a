#pragma once

#include "picture/lettering.h"
#include "picture/picture.h"

namespace mssim {

enum class Corner { top_left, top_right, bottom_left, bottom_right };

/// The sizes of what is written on a picture, in pixels.
struct LegendSizes {
  explicit LegendSizes(const Picture& picture);

  Letters letters;
  /// Around the content of a panel, and between panel and edge of the picture.
  int padding, margin;
  /// What a content may take up, so that most of the picture stays free.
  int most_width, most_height;
};

/// Draws a slightly translucent panel for a content of this size into a corner. Returns where the content
/// goes.
PixelBox draw_panel(Picture& picture, int content_width, int content_height, Corner corner);

}  // namespace mssim
