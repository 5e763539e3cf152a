#pragma once

#include <string_view>

namespace mssim {

/// A character as strokes on a grid: y is 0 on the baseline, 18 at the top of x, 26 at the top of X and -8 at
/// the foot of p; x is 0 at the leftmost stem. A stroke is the middle line of what a round pen leaves. Words
/// of `strokes`:
///
///     M x y          the pen is put down at x, y
///     L x y          a straight line to x, y
///     H x y          a quarter of an ellipse to x, y that begins horizontally, and so ends vertically
///     V x y          one that begins vertically
///     Q a b x y      a parabola to x, y with the control point a, b
///     D x y          a dot, wider than the pen
///     S x            at the beginning: the axis that a symmetric character is symmetric to when it is fitted
///     to pixels
struct Glyph {
  char32_t character;
  /// Between the leftmost and the rightmost stem.
  double width;
  std::string_view strokes;
};

/// How a character is drawn; an empty box for one that is not known.
const Glyph& glyph_of(char32_t character);

}  // namespace mssim
