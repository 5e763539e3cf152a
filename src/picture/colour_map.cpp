#include "picture/colour_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mssim {
namespace {

/// Lightness L* of CIE 1976, from 0 (black) to 100 (white), which is what remains in black and white. Chroma
/// (0 is grey) and hue of Oklab (B. Ottosson, "A perceptual color space for image processing", 2020), which
/// keep their look when it changes.
struct Lch {
  double lightness, chroma, hue_degrees;
};

using LinearRgb = std::array<double, 3>;

/// By the matrices of that publication.
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

/// The share of white's light that `colour` has, from its L* by the standard's two formulas.
double luminance_of(const Lch& colour) {
  const double root = (colour.lightness + 16) / 116;
  return colour.lightness > 8 ? root * root * root : colour.lightness * 27 / 24389;
}

/// The number between `low` and `high` where `above` begins to hold.
template <class Above>
double bisected(double low, double high, const Above& above) {
  for (int halvings = 0; halvings < 20; ++halvings) {
    const double middle = (low + high) / 2;
    (above(middle) ? high : low) = middle;
  }
  return low;
}

/// With that chroma instead of its own.
LinearRgb with_chroma(const Lch& colour, double chroma) {
  const double wanted = luminance_of(colour);
  const double lightness = bisected(0, 1, [&](double value) {
    const LinearRgb rgb = linear_rgb(value, chroma, colour.hue_degrees);
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2] > wanted;
  });
  return linear_rgb(lightness, chroma, colour.hue_degrees);
}

/// The colour, or the most colourful one of its lightness and hue that sRGB has.
Rgb srgb(const Lch& colour) {
  const auto is_outside = [&](double chroma) {
    return std::ranges::any_of(with_chroma(colour, chroma),
                               [](double value) { return value < -1e-4 || value > 1 + 1e-4; });
  };
  const bool fits = !is_outside(colour.chroma);
  const LinearRgb rgb = with_chroma(colour, fits ? colour.chroma : bisected(0, colour.chroma, is_outside));
  const auto channel = [](double linear) {
    linear = std::clamp(linear, 0.0, 1.0);
    const double value = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * value));
  };
  return {channel(rgb[0]), channel(rgb[1]), channel(rgb[2])};
}

/// The map whose colour at a share is `colour_at(share)`.
template <class ColourAt>
ColourMap map_of(const ColourAt& colour_at) {
  ColourMap map{};
  for (std::size_t i = 0; i < map.colours.size(); ++i)
    map.colours[i] = srgb(colour_at(static_cast<double>(i) / static_cast<double>(map.colours.size() - 1)));
  return map;
}

}  // namespace

Rgb ColourMap::at(double share) const {
  if (std::isnan(share)) return {128, 128, 128};
  const auto last = static_cast<double>(colours.size() - 1);
  return colours[static_cast<std::size_t>(std::lround(std::clamp(share, 0.0, 1.0) * last))];
}

const ColourMap& sequential_map() {
  // The hue goes up through red (20 degrees) to yellow. Chroma is largest in the middle, where sRGB has most
  // of it.
  static const ColourMap map = map_of([](double share) {
    return Lch{12 + 82 * share, 0.12 + 0.24 * share * (1 - share), -75 + 178 * share};
  });
  return map;
}

const ColourMap& diverging_map() {
  static const ColourMap map = map_of([](double share) {
    const double distance = std::abs(2 * share - 1);
    return Lch{94 - 58 * distance, 0.155 * distance, share < 0.5 ? 258.0 : 30.0};
  });
  return map;
}

const std::array<Rgb, 8>& category_colours() {
  static const std::array<Rgb, 8> colours{
      srgb({32.5, 0.16, 257}),  // blue
      srgb({75, 0.16, 65}),     // orange
      srgb({57.5, 0.14, 152}),  // green
      srgb({92, 0.16, 102}),    // yellow
      srgb({19, 0.15, 305}),    // violet
      srgb({83, 0.09, 225}),    // light blue
      srgb({41.5, 0.19, 27}),   // red
      srgb({66.5, 0.16, 350}),  // pink
  };
  return colours;
}

}  // namespace mssim
