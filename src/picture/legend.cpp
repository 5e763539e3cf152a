#include "picture/legend.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

namespace mssim {

void draw_legend(Picture& picture, std::span<const LegendEntry> entries, Corner corner) {
  if (entries.empty()) return;
  const LegendSizes sizes(picture);
  const Letters& letters = sizes.letters;
  const int capital = letters.capital_height(), line = letters.line_distance();
  const int swatch = capital + 2, names_from = swatch + static_cast<int>(std::lround(0.6 * letters.size_px));

  // The last line is a count where the list is too long, so that two entries make room for one count.
  const auto most_lines = static_cast<std::size_t>(std::max(2, (sizes.most_height - swatch) / line + 1));
  const std::size_t shown = entries.size() <= most_lines ? entries.size() : most_lines - 1;
  std::vector<std::string> names;
  for (const LegendEntry& entry : entries.first(shown))
    names.push_back(shortened(entry.name, sizes.most_width - names_from, letters));
  if (shown < entries.size()) names.push_back("and " + std::to_string(entries.size() - shown) + " more");

  int widest = 0;
  for (const std::string_view name : names) widest = std::max(widest, text_width(name, letters));
  const int height = static_cast<int>(names.size() - 1) * line + swatch;
  const PixelBox content = draw_panel(picture, names_from + widest, height, corner);
  int top = content.top;
  for (std::size_t i = 0; i < names.size(); ++i, top += line) {
    if (i < shown) fill(picture, {content.left, top, swatch, swatch}, entries[i].colour);
    draw_text(picture, names[i], content.left + names_from, top + 1 + capital, letters);
  }
}

}  // namespace mssim
