#include "picture/legend.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "picture/lettering.h"
#include "text/text.h"

namespace mssim {
namespace {

/// All labels of a scale have the same number of decimals, as many as 10^exponent has, and a minus as wide as
/// a plus.
std::string tick_label(double value, int exponent) {
  if (value == 0) return "0";
  if (value < 0) return "−" + tick_label(-value, exponent);
  if (exponent < -6 || value >= 1e9) return decimal(value);
  return exponent < 0 ? fixed_decimal(value, -exponent)
                      : grouped(static_cast<std::uint64_t>(std::llround(value)));
}

/// mantissa * 10^exponent, correctly rounded if both factors are exact.
double decimal_product(double mantissa, int exponent) {
  return exponent < 0 ? mantissa / std::pow(10.0, -exponent) : mantissa * std::pow(10.0, exponent);
}

/// Lightness L* of CIE 1976, from 8 (almost black) to 100 (white), which is what remains in black and white.
/// Chroma (0 is grey) and hue of Oklab (B. Ottosson, "A perceptual color space for image processing", 2020),
/// which look the same at every lightness.
struct Lch {
  double lightness, chroma, hue_degrees;
};

using LinearRgb = std::array<double, 3>;

/// Uses the matrices of that publication.
LinearRgb linear_rgb(double oklab_lightness, double chroma, double hue_degrees) {
  const double angle = hue_degrees * std::numbers::pi / 180;
  const double a = chroma * std::cos(angle), b = chroma * std::sin(angle);
  const auto cube = [](double root) { return root * root * root; };
  const double l = cube(oklab_lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(oklab_lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(oklab_lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

/// The colour, which must be in sRGB: with the lightness in Oklab that has the luminance of its L*, by the
/// formula for L* above 8.
Rgb srgb(const Lch& colour) {
  const double root = (colour.lightness + 16) / 116, luminance = root * root * root;
  const auto with_lightness = [&](double oklab_lightness) {
    return linear_rgb(oklab_lightness, colour.chroma, colour.hue_degrees);
  };
  double low = 0, high = 1;
  for (int halvings = 0; halvings < 20; ++halvings) {
    const double middle = (low + high) / 2;
    const LinearRgb rgb = with_lightness(middle);
    (0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2] > luminance ? high : low) = middle;
  }
  const LinearRgb rgb = with_lightness(low);
  const auto channel = [](double linear) {
    assert(linear > -1e-4 && linear < 1 + 1e-4);
    return static_cast<std::uint8_t>(std::lround(255 * srgb_code(std::clamp(linear, 0.0, 1.0))));
  };
  return {channel(rgb[0]), channel(rgb[1]), channel(rgb[2])};
}

/// Sizes of a legend, in pixels.
struct LegendSizes {
  Letters letters;
  /// Between the content and the edge of a panel, and between panel and edge of the picture.
  int margin;
  /// Limits of the content, so that most of the picture stays free.
  int most_width, most_height;

  explicit LegendSizes(const Picture& picture)
      : letters{letter_size_for(picture.height), Rgb{32, 34, 40}},
        margin(static_cast<int>(std::lround(0.6 * letters.size_px))),
        most_width(std::max(0, static_cast<int>(0.45 * picture.width) - 4 * margin)),
        most_height(std::max(0, static_cast<int>(0.8 * picture.height) - 4 * margin)) {}
};

/// Draws a slightly translucent panel for content of this size. Returns the box of the content.
PixelBox draw_panel(Picture& picture, int content_width, int content_height) {
  constexpr Rgb edge{190, 193, 200};
  constexpr std::uint8_t coverage = 225;
  const int margin = LegendSizes(picture).margin;
  const int width = content_width + 2 * margin, height = content_height + 2 * margin;
  const int left = static_cast<int>(picture.width) - margin - width, top = margin;
  fill(picture, {left, top, width, height}, white, coverage);
  fill(picture, {left, top, width, 1}, edge);
  fill(picture, {left, top + height - 1, width, 1}, edge);
  fill(picture, {left, top + 1, 1, height - 2}, edge);
  fill(picture, {left + width - 1, top + 1, 1, height - 2}, edge);
  return {left + margin, top + margin, content_width, content_height};
}

}  // namespace

std::vector<Tick> ticks_between(double low, double high, int most) {
  const double distance = high - low;
  if (!std::isfinite(distance) || distance < 0)
    throw std::invalid_argument("a scale needs finite ends in increasing order");
  // Multiples of smaller steps could not be counted, nor could steps below the smallest numbers.
  if (distance <= 1e-9 * std::max(std::abs(low), std::abs(high)) || distance < 1e-290)
    return {{low, (low < 0 ? "−" : "") + decimal(std::abs(low))}};
  // Includes multiples that rounding has moved beyond an end.
  const double slack = 1e-9;
  const int largest = static_cast<int>(std::floor(std::log10(distance)));
  for (int exponent = largest - 2;; ++exponent)
    for (const int digit : {1, 2, 5}) {
      const double step = decimal_product(digit, exponent);
      const double first = std::ceil(low / step - slack), last = std::floor(high / step + slack);
      if (last - first + 1 > most) continue;
      std::vector<Tick> ticks;
      for (double multiple = first; multiple <= last; ++multiple) {
        const double value = decimal_product(multiple * digit, exponent);
        ticks.push_back({value, tick_label(value, exponent)});
      }
      return ticks;
    }
}

Rgb diverging_colour(double share) {
  // An odd number, so that one is in the middle.
  static const auto colours = [] {
    std::array<Rgb, 257> all{};
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double at = static_cast<double>(i) / static_cast<double>(all.size() - 1);
      const double distance = std::abs(2 * at - 1);
      all[i] = srgb({94 - 58 * distance, 0.155 * distance, at < 0.5 ? 258.0 : 30.0});
    }
    return all;
  }();
  if (std::isnan(share)) return {128, 128, 128};
  const auto last = static_cast<double>(colours.size() - 1);
  return colours[static_cast<std::size_t>(std::lround(std::clamp(share, 0.0, 1.0) * last))];
}

const std::array<Rgb, 8>& category_colours() {
  static const std::array<Rgb, 8> colours{
      srgb({32.5, 0.15, 257}),  // blue
      srgb({75, 0.155, 65}),    // orange
      srgb({57.5, 0.14, 152}),  // green
      srgb({92, 0.16, 102}),    // yellow
      srgb({19, 0.15, 305}),    // violet
      srgb({83, 0.09, 225}),    // light blue
      srgb({41.5, 0.19, 27}),   // red
      srgb({66.5, 0.16, 350}),  // pink
  };
  return colours;
}

void draw_legend(Picture& picture, std::span<const LegendEntry> entries) {
  if (entries.empty()) return;
  const LegendSizes sizes(picture);
  const Letters& letters = sizes.letters;
  const int capital = letters.capital_height(), line = letters.line_distance();
  const int swatch = capital + 2, names_from = swatch + static_cast<int>(std::lround(0.6 * letters.size_px));

  // If the list is too long, the last line is a count; so there are at least two lines.
  const auto most_lines = static_cast<std::size_t>(std::max(2, (sizes.most_height - swatch) / line + 1));
  const std::size_t shown = entries.size() <= most_lines ? entries.size() : most_lines - 1;
  std::vector<std::string> names;
  for (const LegendEntry& entry : entries.first(shown))
    names.push_back(shortened(entry.name, sizes.most_width - names_from, letters));
  if (shown < entries.size()) names.push_back(fmt::format("and {} more", entries.size() - shown));

  int widest = 0;
  for (const std::string_view name : names) widest = std::max(widest, text_width(name, letters));
  const int height = static_cast<int>(names.size() - 1) * line + swatch;
  const PixelBox content = draw_panel(picture, names_from + widest, height);
  int top = content.top;
  for (std::size_t i = 0; i < names.size(); ++i, top += line) {
    if (i < shown) fill(picture, {content.left, top, swatch, swatch}, entries[i].colour);
    draw_text(picture, names[i], content.left + names_from, top + 1 + capital, letters);
  }
}

void draw_colour_bar(Picture& picture, double low, double high, const std::string& title) {
  const LegendSizes sizes(picture);
  const Letters& letters = sizes.letters;
  const std::string head = shortened(title, sizes.most_width, letters);
  const std::vector<Tick> ticks = ticks_between(low, high, 6);
  const int capital = letters.capital_height();
  const int thickness = static_cast<int>(std::lround(1.1 * letters.size_px));
  // Width of the line next to a number, and of the space after it.
  const int dash = static_cast<int>(std::lround(0.3 * letters.size_px)), labels_from = thickness + 2 * dash;
  int width = text_width(head, letters);
  for (const Tick& tick : ticks) width = std::max(width, labels_from + text_width(tick.label, letters));
  const int title_height = head.empty() ? 0 : letters.line_distance();
  const int free = sizes.most_height - title_height - capital;
  const int length = std::max(8, std::min(free, static_cast<int>(std::lround(11 * letters.size_px))));
  // A number at an end extends half its height beyond the bar.
  const int bar_from = title_height + capital / 2;
  const PixelBox content = draw_panel(picture, width, bar_from + length + capital / 2);
  draw_text(picture, head, content.left, content.top + capital, letters);
  const int low_end = content.top + bar_from + length - 1;
  for (int i = 0; i < length; ++i)
    fill(picture, {content.left, low_end - i, thickness, 1},
         diverging_colour(static_cast<double>(i) / (length - 1)));
  for (const Tick& tick : ticks) {
    const int above_low =
        low == high ? length / 2
                    : static_cast<int>(std::lround((tick.value - low) / (high - low) * (length - 1)));
    const int y = low_end - above_low;
    fill(picture, {content.left + thickness, y, dash, 1}, letters.colour);
    draw_text(picture, tick.label, content.left + labels_from, y + (capital + 1) / 2, letters);
  }
}

}  // namespace mssim
