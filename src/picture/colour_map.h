#pragma once

#include <array>
#include <cstddef>

#include "picture/picture.h"

namespace mssim {

/// Colours for the numbers between two ends.
struct ColourMap {
  /// At equal distances, the first for the lower end. They are so many that one is in the middle.
  std::array<Rgb, 257> colours;

  /// The colour at `share` of the way from the lower end to the upper. What lies beyond an end has its
  /// colour, and what is not a number is grey.
  Rgb at(double share) const;
};

/// For an amount, from dark violet over red to light yellow. Lightness grows evenly, so that it reads in
/// black and white.
const ColourMap& sequential_map();

/// For what is less or more than the middle, such as compression and stretch: from blue over light grey to
/// red. Lightness falls evenly from the middle to both ends.
const ColourMap& diverging_map();

/// For names. No two are equally light, so that they can be told apart with any colour vision and, less
/// easily, in black and white. The first ones differ most.
const std::array<Rgb, 8>& category_colours();

}  // namespace mssim
