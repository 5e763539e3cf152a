#include "picture/colour_bar.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "picture/ticks.h"

namespace mssim {
namespace {

/// Where things lie, in pixels.
struct BarLayout {
  LegendSizes sizes;
  std::vector<Tick> ticks;
  std::string title;
  int title_width, title_height;  ///< with the space below it
  int length, thickness;          ///< of the bar
  int dash;                       ///< of the line beside a number, and the space after it

  BarLayout(const Picture& picture, const ColourBar& bar) : sizes(picture) {
    const Letters& letters = sizes.letters;
    title = shortened(bar.title, sizes.most_width, letters);
    title_width = text_width(title, letters);
    title_height = title.empty() ? 0 : letters.line_distance();
    thickness = static_cast<int>(std::lround(1.1 * letters.size_px));
    dash = static_cast<int>(std::lround(0.3 * letters.size_px));
    const int free =
        bar.upright ? sizes.most_height - title_height - letters.capital_height() : sizes.most_width;
    length =
        std::max(8, std::min(free, static_cast<int>(std::lround((bar.upright ? 11 : 16) * letters.size_px))));
    ticks = ticks_between(bar.low, bar.high, 6);
    if (bar.upright) return;
    // As many numbers as have room beside each other.
    for (int most = 6; most > 2 && widest_label() * 3 / 2 * static_cast<int>(ticks.size()) > length; --most)
      ticks = ticks_between(bar.low, bar.high, most - 1);
  }

  int widest_label() const {
    int widest = 0;
    for (const Tick& tick : ticks) widest = std::max(widest, text_width(tick.label, sizes.letters));
    return widest;
  }
};

/// The pixel of a bar of `length` pixels at which `value` lies, from its low end.
int place_of(double value, const ColourBar& bar, int length) {
  if (bar.low == bar.high) return length / 2;
  return static_cast<int>(std::lround((value - bar.low) / (bar.high - bar.low) * (length - 1)));
}

/// Draws the bar with its upper left corner at the place given.
void draw_bar(Picture& picture, const ColourBar& bar, const BarLayout& layout, int left, int top) {
  for (int i = 0; i < layout.length; ++i) {
    const Rgb colour = bar.map.at(static_cast<double>(i) / (layout.length - 1));
    if (bar.upright)
      fill(picture, {left, top + layout.length - 1 - i, layout.thickness, 1}, colour);
    else
      fill(picture, {left + i, top, 1, layout.thickness}, colour);
  }
}

void draw_upright(Picture& picture, const ColourBar& bar, const BarLayout& layout, Corner corner) {
  const Letters& letters = layout.sizes.letters;
  const int capital = letters.capital_height(), labels_from = layout.thickness + 2 * layout.dash;
  const int width = std::max(layout.title_width, labels_from + layout.widest_label());
  // A number at an end reaches half its height beyond the bar.
  const int bar_from = layout.title_height + capital / 2;
  const PixelBox content = draw_panel(picture, width, bar_from + layout.length + capital / 2, corner);
  draw_text(picture, layout.title, content.left, content.top + capital, letters);
  draw_bar(picture, bar, layout, content.left, content.top + bar_from);
  for (const Tick& tick : layout.ticks) {
    const int y = content.top + bar_from + layout.length - 1 - place_of(tick.value, bar, layout.length);
    fill(picture, {content.left + layout.thickness, y, layout.dash, 1}, letters.colour);
    draw_text(picture, tick.label, content.left + labels_from, y + (capital + 1) / 2, letters);
  }
}

void draw_lying(Picture& picture, const ColourBar& bar, const BarLayout& layout, Corner corner) {
  const Letters& letters = layout.sizes.letters;
  const int capital = letters.capital_height(), half_label = layout.widest_label() / 2;
  const int labels_from = layout.title_height + layout.thickness + 2 * layout.dash;
  const int width = std::max(layout.title_width, layout.length + 2 * half_label);
  const PixelBox content = draw_panel(picture, width, labels_from + capital, corner);
  draw_text(picture, layout.title, content.left, content.top + capital, letters);
  const int left = content.left + half_label, top = content.top + layout.title_height;
  draw_bar(picture, bar, layout, left, top);
  for (const Tick& tick : layout.ticks) {
    const int x = left + place_of(tick.value, bar, layout.length);
    fill(picture, {x, top + layout.thickness, 1, layout.dash}, letters.colour);
    draw_text(picture, tick.label, x, content.top + labels_from + capital, letters, Alignment::centre);
  }
}

}  // namespace

void draw_colour_bar(Picture& picture, const ColourBar& bar, Corner corner) {
  const BarLayout layout(picture, bar);
  (bar.upright ? draw_upright : draw_lying)(picture, bar, layout, corner);
}

}  // namespace mssim
