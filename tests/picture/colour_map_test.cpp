#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "picture/legend.h"

namespace mssim {
namespace {

using Linear = std::array<double, 3>;

Linear linear(Rgb colour) {
  const auto channel = [](std::uint8_t value) {
    const double share = value / 255.0;
    return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  };
  return {channel(colour.red), channel(colour.green), channel(colour.blue)};
}

/// CIE's L*.
double lightness(const Linear& rgb) {
  const double y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

double lightness(Rgb colour) { return lightness(linear(colour)); }

TEST(SequentialMap, GrowsEvenlyInLightness) {
  const auto& colours = sequential_map().colours;
  EXPECT_NEAR(lightness(colours.front()), 12, 1);
  EXPECT_NEAR(lightness(colours.back()), 94, 1);
  for (std::size_t i = 8; i < colours.size(); ++i)
    EXPECT_NEAR(lightness(colours[i]) - lightness(colours[i - 8]), 8 * 82 / 256.0, 0.8) << i;
}

TEST(SequentialMap, HasNoJumps) {
  for (const ColourMap* map : {&sequential_map(), &diverging_map()})
    for (std::size_t i = 1; i < map->colours.size(); ++i) {
      const Rgb a = map->colours[i - 1], b = map->colours[i];
      for (const int step : {a.red - b.red, a.green - b.green, a.blue - b.blue})
        EXPECT_LE(std::abs(step), 8) << i;
    }
}

TEST(DivergingMap, IsLightestAndGreyInTheMiddleAndAsLightOnBothSides) {
  const auto& colours = diverging_map().colours;
  const Rgb middle = diverging_map().at(0.5);
  EXPECT_EQ(middle, colours[128]);
  EXPECT_LE(
      std::max({middle.red, middle.green, middle.blue}) - std::min({middle.red, middle.green, middle.blue}),
      1);
  for (std::size_t i = 0; i <= 128; ++i) {
    EXPECT_NEAR(lightness(colours[i]), lightness(colours[256 - i]), 0.8) << i;
    EXPECT_NEAR(lightness(colours[i]), 36 + 58 * static_cast<double>(i) / 128, 0.8) << i;
  }
  EXPECT_GT(colours.front().blue, colours.front().red + 100);
  EXPECT_GT(colours.back().red, colours.back().blue + 100);
}

TEST(ColourMap, ClampsAndShowsWhatIsNoNumberInGrey) {
  const ColourMap& map = sequential_map();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(map.at(-3), map.colours.front());
  EXPECT_EQ(map.at(-infinity), map.colours.front());
  EXPECT_EQ(map.at(infinity), map.colours.back());
  EXPECT_EQ(map.at(0.25), map.colours[64]);
  EXPECT_EQ(map.at(std::nan("")), (Rgb{128, 128, 128}));
}

TEST(CategoryColours, DifferInLightness) {
  const auto& colours = category_colours();
  for (std::size_t i = 0; i < colours.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_GT(std::abs(lightness(colours[i]) - lightness(colours[k])), 8) << k << ' ' << i;
}

/// What a person without red or without green cones sees (Viénot, Brettel and Mollon 1999): red and green are
/// confused, with these shares of their light.
Linear confused(const Linear& rgb, double red_share) {
  const double mixed = red_share * rgb[0] + (1 - red_share) * rgb[1];
  return {mixed, mixed, rgb[2]};
}

TEST(CategoryColours, DifferWithoutRedOrGreenCones) {
  const auto& colours = category_colours();
  for (const double red_share : {0.1124, 0.2928})
    for (std::size_t i = 0; i < colours.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) {
        const Linear a = confused(linear(colours[i]), red_share), b = confused(linear(colours[k]), red_share);
        const double yellowness =
            60 * (std::cbrt(a[0]) - std::cbrt(a[2]) - std::cbrt(b[0]) + std::cbrt(b[2]));
        EXPECT_GT(std::hypot(lightness(a) - lightness(b), yellowness), 12)
            << k << ' ' << i << ' ' << red_share;
      }
}

}  // namespace
}  // namespace mssim
