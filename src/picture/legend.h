#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "picture/picture.h"

namespace mssim {

/// A number at a scale, and how it is written.
struct Tick {
  double value;
  std::string label;
};

/// The multiples of 1, 2 or 5 times a power of ten from `low` to `high`: at most `most`, which is positive,
/// and at least two if `most` is at least 5. `low` alone where `high` is the same to nine digits. Throws
/// std::invalid_argument unless `low`, `high` and their distance are finite and they are in order.
std::vector<Tick> ticks_between(double low, double high, int most);

/// Colours for the numbers between two ends.
struct ColourMap {
  /// At equal distances, the first for the lower end. They are so many that one is in the middle.
  std::array<Rgb, 257> colours;

  /// The colour at `share` of the way from the lower end to the upper. What lies beyond an end has its
  /// colour, and what is not a number is grey.
  Rgb at(double share) const;
};

/// For what is less or more than the middle, such as compression and stretch: from blue over light grey to
/// red. Lightness falls evenly from the middle to both ends.
const ColourMap& diverging_map();

/// For names. No two are equally light, so that they can be told apart with any colour vision and, less
/// easily, in black and white. The first ones differ most.
const std::array<Rgb, 8>& category_colours();

/// What a colour stands for.
struct LegendEntry {
  Rgb colour;
  std::string name;
};

/// Draws a list of colours and their names, in UTF-8, on a panel at the upper right. A name too long is
/// shortened; a list too long ends with how many more there are. Nothing is drawn for an empty list.
void draw_legend(Picture& picture, std::span<const LegendEntry> entries);

/// Which colour stands for which number.
struct ColourBar {
  const ColourMap& map;
  /// The numbers at the ends of the map.
  double low, high;
  /// What the numbers are and their unit, as in "strain in %"; may be empty.
  std::string title;
};

/// Draws an upright colour bar with its title and some numbers on a panel at the upper right. A title too
/// long is shortened. Throws std::invalid_argument unless `low` and `high` are finite and in order; where
/// they are the same, the only number stands at the middle.
void draw_colour_bar(Picture& picture, const ColourBar& bar);

}  // namespace mssim
