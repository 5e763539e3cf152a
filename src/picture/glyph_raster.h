#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "picture/glyphs.h"

namespace mssim {

/// The pen of letters of one size, in pixels. At every size, stems and bars lie on whole pixels.
struct Pen {
  explicit Pen(double size_px);

  /// Pixels of a unit of the grid of `Glyph`.
  double scale;
  double width;
  /// The whole pixels that a line covers completely.
  int line;
};

/// How much of each pixel a character covers, of 255: rows from the top, with the place of the first pixel
/// relative to where the baseline meets the left edge of the character. Inked rows above the baseline are
/// negative.
struct GlyphMask {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<std::uint8_t> coverage;

  /// Where `coverage` has the pixel in column `x` of row `y` of the mask.
  std::size_t index_of(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

GlyphMask mask_of(const Glyph& glyph, const Pen& pen);

/// From the left edge of a character to its right edge.
int width_px(const Glyph& glyph, const Pen& pen);

}  // namespace mssim
