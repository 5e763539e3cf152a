#include "picture/legend.h"

#include "tests/support/picture_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

std::vector<LegendEntry> entries_of(std::size_t count, const std::string& name) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < count; ++i)
    entries.push_back({{static_cast<std::uint8_t>(i + 1), 77, 200}, name});
  return entries;
}

Picture with_legend(std::uint32_t width, std::uint32_t height, const std::vector<LegendEntry>& entries) {
  Picture picture(width, height, ground);
  draw_legend(picture, entries);
  return picture;
}

TEST(Legend, LetsThePictureShowThrough) {
  Picture dark(640, 480, black), light(640, 480, white);
  for (Picture* picture : {&dark, &light}) draw_legend(*picture, entries_of(1, "x"));
  const PixelBox box = ink_of(dark, black).value();
  const auto x = static_cast<std::uint32_t>(box.left + 2), y = static_cast<std::uint32_t>(box.top + 2);
  EXPECT_GT(dark.at(x, y).red, 200);
  EXPECT_LT(dark.at(x, y).red, light.at(x, y).red);
}

TEST(Legend, GrowsWithThePicture) {
  const auto entries = entries_of(2, "panel");
  const int small = ink_of(with_legend(320, 240, entries), ground)->height;
  EXPECT_EQ(ink_of(with_legend(480, 360, entries), ground)->height, small) << "letters of 11 px at least";
  EXPECT_GT(ink_of(with_legend(1920, 1080, entries), ground)->height, 2 * small);
}

TEST(Legend, ShortensNamesThatAreTooLong) {
  const PixelBox box = ink_of(with_legend(640, 480, entries_of(2, std::string(300, 'n'))), ground).value();
  EXPECT_LE(box.width, 0.45 * 640);
  EXPECT_GT(box.width, 0.35 * 640);
}

TEST(Legend, CountsWhatHasNoRoom) {
  const auto entries = entries_of(100, "panel");
  const Picture picture = with_legend(640, 480, entries);
  EXPECT_LE(ink_of(picture, ground)->height, 0.8 * 480);
  std::size_t shown = 0;
  while (shown < entries.size() && box_of_colour(picture, entries[shown].colour)) ++shown;
  EXPECT_GT(shown, 10u);
  EXPECT_LT(shown, 30u);
  for (std::size_t i = shown; i < entries.size(); ++i)
    EXPECT_FALSE(box_of_colour(picture, entries[i].colour));

  // The same lines written as entries, the last one without a colour of its own, show that it is the count.
  std::vector<LegendEntry> lines(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(shown));
  lines.push_back({entries.back().colour, "and " + std::to_string(entries.size() - shown) + " more"});
  const Picture counted = with_legend(640, 480, lines);
  const PixelBox swatch = box_of_colour(counted, entries.back().colour).value();
  for (std::uint32_t y = 0; y < counted.height; ++y)
    for (std::uint32_t x = 0; x < counted.width; ++x)
      if (static_cast<int>(x) >= swatch.left + swatch.width || static_cast<int>(y) < swatch.top) {
        ASSERT_EQ(counted.at(x, y), picture.at(x, y)) << x << ' ' << y;
      }

  const std::vector<LegendEntry> fitting(entries.begin(),
                                         entries.begin() + static_cast<std::ptrdiff_t>(shown + 1));
  EXPECT_TRUE(box_of_colour(with_legend(640, 480, fitting), fitting.back().colour))
      << "all where all have room";
}

TEST(Legend, DrawsNothingWithoutEntriesAndSurvivesTinyPictures) {
  EXPECT_FALSE(ink_of(with_legend(640, 480, {}), ground));
  for (const std::uint32_t size : {1u, 7u, 30u}) with_legend(size, size, entries_of(5, "panel"));
}

Picture with_bar(std::uint32_t width, std::uint32_t height, double low, double high,
                 const std::string& title) {
  Picture picture(width, height, ground);
  draw_colour_bar(picture, low, high, title);
  return picture;
}

TEST(ColourBar, MarksNumbersWhereTheirColoursAre) {
  const Picture picture = with_bar(640, 480, -1, 1, "");
  const PixelBox low = box_of_colour(picture, diverging_colour(0)).value();
  const PixelBox high = box_of_colour(picture, diverging_colour(1)).value();
  // Just right of the bar: dashes at -1, -0.5, 0, 0.5 and 1.
  const auto x = static_cast<std::uint32_t>(low.left + low.width);
  std::vector<int> dashes;
  for (std::uint32_t y = 0; y < picture.height; ++y)
    if (picture.at(x, y).red < 60) dashes.push_back(static_cast<int>(y));
  ASSERT_EQ(dashes.size(), 5u);
  EXPECT_EQ(dashes.front(), high.top);
  EXPECT_EQ(dashes.back(), low.top + low.height - 1);
  for (std::size_t i = 1; i < dashes.size(); ++i)
    EXPECT_NEAR(dashes[i] - dashes[i - 1], (dashes.back() - dashes.front()) / 4.0, 1);
}

TEST(ColourBar, HasItsTitleOnlyWhereThereIsOne) {
  const auto extent = [](const std::string& title) {
    return ink_of(with_bar(640, 480, 0, 1, title), ground).value();
  };
  EXPECT_GT(extent("strain in %").height, extent("").height + 10);
  EXPECT_LE(extent(std::string(300, 'n')).width, 0.45 * 640);
}

TEST(ColourBar, ShowsARangeWithoutLength) {
  EXPECT_TRUE(box_of_colour(with_bar(640, 480, 0, 0, "strain"), diverging_colour(0)));
}

TEST(ColourBar, RefusesARangeThatIsNone) {
  EXPECT_THROW(with_bar(640, 480, 1, 0, "strain"), std::invalid_argument);
}

TEST(ColourBar, SurvivesTinyPicturesAndLongNumbers) {
  for (const std::uint32_t size : {1u, 7u, 30u, 100u}) {
    with_bar(size, size, 0, 1, "strain");
    with_bar(size, size, 123'456'788, 123'456'799, "strain");
    with_bar(size, size, 1e17, 1e17 + 64, "strain");
  }
}

/// CIE's L*.
double lightness(Rgb colour) {
  const auto linear = [](std::uint8_t value) {
    const double share = value / 255.0;
    return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  };
  const double y = 0.2126 * linear(colour.red) + 0.7152 * linear(colour.green) + 0.0722 * linear(colour.blue);
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

TEST(DivergingColour, IsLightestAndGreyInTheMiddleAndAsLightOnBothSides) {
  const Rgb middle = diverging_colour(0.5), low = diverging_colour(0), high = diverging_colour(1);
  EXPECT_LE(
      std::max({middle.red, middle.green, middle.blue}) - std::min({middle.red, middle.green, middle.blue}),
      1);
  for (int i = 0; i <= 128; ++i) {
    const double share = i / 256.0;
    EXPECT_NEAR(lightness(diverging_colour(share)), lightness(diverging_colour(1 - share)), 0.8) << i;
    EXPECT_NEAR(lightness(diverging_colour(share)), 36 + 58 * static_cast<double>(i) / 128, 0.8) << i;
  }
  EXPECT_GT(low.blue, low.red + 100);
  EXPECT_GT(high.red, high.blue + 100);
}

TEST(DivergingColour, IsThatOfAnEndBeyondItAndGreyWithoutANumber) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(diverging_colour(0), (Rgb{15, 82, 170}));
  EXPECT_EQ(diverging_colour(1), (Rgb{158, 42, 29}));
  EXPECT_EQ(diverging_colour(-3), diverging_colour(0));
  EXPECT_EQ(diverging_colour(-infinity), diverging_colour(0));
  EXPECT_EQ(diverging_colour(infinity), diverging_colour(1));
  EXPECT_EQ(diverging_colour(std::nan("")), (Rgb{128, 128, 128}));
}

TEST(CategoryColours, DifferInLightness) {
  const auto& colours = category_colours();
  for (std::size_t i = 0; i < colours.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_GT(std::abs(lightness(colours[i]) - lightness(colours[k])), 8) << k << ' ' << i;
}

std::string labels(double low, double high, int most = 6) {
  std::string text;
  for (const Tick& tick : ticks_between(low, high, most)) text += (text.empty() ? "" : " ") + tick.label;
  return text;
}

TEST(Ticks, AreRoundNumbersWithTheSameDigits) {
  EXPECT_EQ(labels(0, 0.37), "0 0.1 0.2 0.3");
  EXPECT_EQ(labels(0, 1), "0 0.2 0.4 0.6 0.8 1.0");
  EXPECT_EQ(labels(-1, 1), "−1.0 −0.5 0 0.5 1.0");
  EXPECT_EQ(labels(1e-4, 3.4e-4), "0.00010 0.00015 0.00020 0.00025 0.00030");
  EXPECT_EQ(labels(12'345, 56'789), "20,000 30,000 40,000 50,000");
  EXPECT_EQ(labels(0, 3e-9), "0 1e-09 2e-09 3e-09");
  EXPECT_EQ(labels(0, 2.1e12), "0 5e+11 1e+12 1.5e+12 2e+12");
}

TEST(Ticks, HaveTheirValuesToTheLastBit) {
  for (const Tick& tick : ticks_between(0, 0.37, 6)) EXPECT_EQ(tick.value, std::stod(tick.label));
  for (const Tick& tick : ticks_between(0, 1.1e-5, 6)) EXPECT_EQ(tick.value, std::stod(tick.label));
}

TEST(Ticks, KeepEndsThatARoundingHasMoved) {
  EXPECT_EQ(labels(0, 0.1 + 0.2), labels(0, 0.3));
  EXPECT_EQ(labels(0.1 + 0.2, 0.8).substr(0, 3), "0.3");
  EXPECT_EQ(labels(-0.3, 0.3), labels(-0.1 - 0.2, 0.29999999999999993));
}

TEST(Ticks, AreAtMostAsManyAsAskedForAndLieInTheRange) {
  for (int most = 1; most <= 9; ++most)
    for (double high = 1e-7; high < 1e9; high *= 1.37)
      for (const double low : {0.0, -high, 0.3 * high, -0.1 * high}) {
        const auto ticks = ticks_between(low, high, most);
        EXPECT_LE(ticks.size(), static_cast<std::size_t>(most)) << low << ' ' << high;
        EXPECT_GE(ticks.size(), most >= 5 ? 2u : 0u) << low << ' ' << high;
        for (const Tick& tick : ticks) {
          EXPECT_GE(tick.value, low - 1e-8 * (high - low));
          EXPECT_LE(tick.value, high + 1e-8 * (high - low));
        }
      }
}

TEST(Ticks, OfARangeWithoutLengthAreItsNumber) {
  EXPECT_EQ(labels(0, 0), "0");
  EXPECT_EQ(labels(-2.5, -2.5), "−2.5");
  EXPECT_EQ(labels(1e17, 1e17 + 32), "1e+17");
  EXPECT_EQ(labels(0, 1e-300), "0");
}

TEST(Ticks, RefuseARangeThatIsNone) {
  const double infinity = std::numeric_limits<double>::infinity(),
               nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ticks_between(1, 0, 6), std::invalid_argument);
  EXPECT_THROW(ticks_between(nan, 0, 6), std::invalid_argument);
  EXPECT_THROW(ticks_between(0, infinity, 6), std::invalid_argument);
  EXPECT_THROW(ticks_between(-1e308, 1e308, 6), std::invalid_argument);
}

}  // namespace
}  // namespace mssim
