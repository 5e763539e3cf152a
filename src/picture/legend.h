#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "picture/picture.h"

namespace mssim {

/// A number on a scale, and its text.
struct Tick {
  double value;
  std::string label;
};

/// The multiples of 1, 2 or 5 times a power of ten from `low` to `high`: at most `most`, which is positive,
/// and at least two if `most` is at least 5. Only `low` if `high` equals it to nine digits. Throws
/// std::invalid_argument unless `low` <= `high` and both and their distance are finite.
std::vector<Tick> ticks_between(double low, double high, int most);

/// Colours for a range of numbers.
struct ColourMap {
  /// Evenly spaced, from the lower end; an odd number, so that one is in the middle.
  std::array<Rgb, 257> colours;

  /// The colour at `share` of the way from the lower end to the upper. Beyond an end it is that end's colour,
  /// for NaN grey.
  Rgb at(double share) const;
};

/// For deviations from a middle value, such as compression and stretch: from blue over light grey to red.
/// Lightness falls evenly from the middle to both ends.
const ColourMap& diverging_map();

/// For names. All differ in lightness, so that they can be told apart with any colour vision and, less
/// easily, in black and white. The first ones differ most.
const std::array<Rgb, 8>& category_colours();

/// A colour and its meaning.
struct LegendEntry {
  Rgb colour;
  std::string name;
};

/// Draws a list of colours and their names, in UTF-8, on a panel at the upper right. Long names are
/// shortened; a long list ends with the number of entries left out. Draws nothing for an empty list.
void draw_legend(Picture& picture, std::span<const LegendEntry> entries);

/// A range of numbers and its colours.
struct ColourBar {
  const ColourMap& map;
  /// The numbers at the ends of the map.
  double low, high;
  /// Quantity and unit, as in "strain in %"; may be empty.
  std::string title;
};

/// Draws an upright colour bar with its title and some numbers on a panel at the upper right. A long title is
/// shortened. Throws std::invalid_argument unless `low` and `high` are finite and in order; if they are
/// equal, the only number is in the middle.
void draw_colour_bar(Picture& picture, const ColourBar& bar);

}  // namespace mssim
