#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "picture/picture.h"

namespace mssim {

/// Size and colour of text in DejaVu Sans. `size_px` is the size of the font: capitals are about 0.73 and x
/// 0.55 of it. Text is readable from 10 px on.
struct Letters {
  double size_px = 14;
  Rgb colour = black;

  /// Whole pixels from the baseline to the top of a capital.
  int capital_height() const;
  /// Whole pixels below the baseline that letters like g reach.
  int descent() const;
  /// Distance between the baselines of two lines.
  int line_distance() const;
};

/// The size of letters in pixels for a picture of this height: 2.5 % of it, at least 11.
double letter_size_for(std::uint32_t picture_height);

/// Pixels from the left edge of the first character to the right edge of the last. `text` is UTF-8; a byte
/// that is not part of a character counts as U+FFFD.
int text_width(std::string_view text, const Letters& letters);

/// Draws a line of text that begins at column `x`; letters without descender end in the row above `baseline`.
/// A character that the font lacks is an empty box. Text outside the picture is cut off.
void draw_text(Picture& picture, std::string_view text, int x, int baseline, const Letters& letters);

/// `text`, or as much of its beginning as fits with "…" into `width` pixels.
std::string shortened(std::string_view text, int width, const Letters& letters);

}  // namespace mssim
