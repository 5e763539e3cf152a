#pragma once

#include <array>
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

/// For deviations from a middle value, such as compression and stretch: the colour at `share` of the way from
/// blue over light grey to red. Lightness falls evenly from the middle to both ends. Beyond an end it is that
/// end's colour, for NaN grey.
Rgb diverging_colour(double share);

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

/// Draws an upright bar of the diverging colours from `low` to `high`, with its title and some numbers, on a
/// panel at the upper right. `title`: quantity and unit, as in "strain in %"; may be empty, and is shortened
/// if it is long. Throws std::invalid_argument unless `low` and `high` are finite and in order; if they are
/// equal, the only number is in the middle.
void draw_colour_bar(Picture& picture, double low, double high, const std::string& title);

}  // namespace mssim
