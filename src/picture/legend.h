#pragma once

#include <span>
#include <string>

#include "picture/legend_panel.h"
#include "picture/picture.h"

namespace mssim {

/// What a colour stands for.
struct LegendEntry {
  Rgb colour;
  std::string name;
};

/// Draws a list of colours and their names, in UTF-8, on a panel in a corner. A name too long is shortened; a
/// list too long ends with how many more there are. Nothing is drawn for an empty list.
void draw_legend(Picture& picture, std::span<const LegendEntry> entries, Corner corner);

}  // namespace mssim
