#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "picture/legend.h"
#include "tests/support/picture_content.h"

namespace mssim {
namespace {

Picture with_bar(std::uint32_t width, std::uint32_t height, const ColourBar& bar) {
  Picture picture(width, height, ground);
  draw_colour_bar(picture, bar, Corner::top_right);
  return picture;
}

TEST(ColourBar, RunsFromLowToHigh) {
  const ColourMap& map = sequential_map();
  for (const bool upright : {true, false}) {
    const Picture picture = with_bar(640, 480, {map, 0, 1, "strain", upright});
    const PixelBox low = box_of_colour(picture, map.colours.front()).value();
    const PixelBox high = box_of_colour(picture, map.colours.back()).value();
    if (upright) {
      EXPECT_EQ(low.left, high.left);
      EXPECT_EQ(low.width, high.width);
      EXPECT_GT(low.top, high.top + 100);
    } else {
      EXPECT_EQ(low.top, high.top);
      EXPECT_EQ(low.height, high.height);
      EXPECT_GT(high.left, low.left + 100);
    }
  }
}

TEST(ColourBar, MarksNumbersWhereTheirColoursAre) {
  const ColourMap& map = diverging_map();
  const Picture picture = with_bar(640, 480, {map, -1, 1, "", true});
  const PixelBox low = box_of_colour(picture, map.colours.front()).value();
  const PixelBox high = box_of_colour(picture, map.colours.back()).value();
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
  const ColourBar bar{sequential_map(), 0, 1, "", false};
  ColourBar titled = bar;
  titled.title = "strain in %";
  EXPECT_GT(ink_of(with_bar(640, 480, titled), ground)->height,
            ink_of(with_bar(640, 480, bar), ground)->height + 10);
  titled.title = std::string(300, 'n');
  EXPECT_LE(ink_of(with_bar(640, 480, titled), ground)->width, 0.45 * 640);
}

TEST(ColourBar, ShowsARangeWithoutLength) {
  for (const bool upright : {true, false}) {
    const ColourMap& map = sequential_map();
    EXPECT_TRUE(box_of_colour(with_bar(640, 480, {map, 0, 0, "strain", upright}), map.colours.front()));
  }
}

TEST(ColourBar, RefusesARangeThatIsNone) {
  EXPECT_THROW(with_bar(640, 480, {sequential_map(), 1, 0, "strain", true}), std::invalid_argument);
}

TEST(ColourBar, SurvivesTinyPicturesAndLongNumbers) {
  for (const std::uint32_t size : {1u, 7u, 30u, 100u})
    for (const bool upright : {true, false}) {
      with_bar(size, size, {sequential_map(), 0, 1, "strain", upright});
      with_bar(size, size, {sequential_map(), 123'456'788, 123'456'799, "strain", upright});
      with_bar(size, size, {sequential_map(), 1e17, 1e17 + 64, "strain", upright});
    }
}

}  // namespace
}  // namespace mssim
