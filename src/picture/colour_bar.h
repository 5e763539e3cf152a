#pragma once

#include <string>

#include "picture/colour_map.h"
#include "picture/legend_panel.h"
#include "picture/picture.h"

namespace mssim {

/// Which colour stands for which number.
struct ColourBar {
  const ColourMap& map;
  /// The numbers at the ends of the map.
  double low, high;
  /// What the numbers are and their unit, as in "strain in %"; may be empty.
  std::string title;
  /// Upright with `high` at the top, or lying with `high` at the right.
  bool upright = true;
};

/// Draws a colour bar with its title and some numbers on a panel in a corner. A title too long is shortened.
/// Throws std::invalid_argument unless `low` and `high` are finite and in order; where they are the same, the
/// only number stands at the middle.
void draw_colour_bar(Picture& picture, const ColourBar& bar, Corner corner);

}  // namespace mssim
