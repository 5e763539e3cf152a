#include "picture/legend.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/picture_content.h"

namespace mssim {
namespace {

std::vector<LegendEntry> entries_of(std::size_t count, const std::string& name) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < count; ++i)
    entries.push_back({{static_cast<std::uint8_t>(i + 1), 77, 200}, name});
  return entries;
}

Picture with_legend(std::uint32_t width, std::uint32_t height, const std::vector<LegendEntry>& entries,
                    Corner corner = Corner::top_left) {
  Picture picture(width, height, ground);
  draw_legend(picture, entries, corner);
  return picture;
}

TEST(Legend, ShowsEachColourOnALineOfItsOwn) {
  const auto entries = entries_of(3, "panel");
  const Picture picture = with_legend(640, 480, entries);
  int last_bottom = 0;
  for (const LegendEntry& entry : entries) {
    const PixelBox swatch = box_of_colour(picture, entry.colour).value();
    EXPECT_GE(swatch.width, 8);
    EXPECT_EQ(swatch.width, swatch.height);
    EXPECT_GT(swatch.top, last_bottom);
    last_bottom = swatch.top + swatch.height;
  }
}

TEST(Legend, StandsInItsCorner) {
  const auto entries = entries_of(2, "panel");
  const PixelBox first = ink_of(with_legend(640, 480, entries), ground).value();
  EXPECT_GT(first.left, 0);
  EXPECT_LT(first.left + first.width, 320);
  for (const auto& [corner, at_right, at_bottom] :
       {std::tuple{Corner::top_left, false, false}, std::tuple{Corner::top_right, true, false},
        std::tuple{Corner::bottom_left, false, true}, std::tuple{Corner::bottom_right, true, true}}) {
    const PixelBox box = ink_of(with_legend(640, 480, entries, corner), ground).value();
    EXPECT_EQ(box.left, at_right ? 640 - first.left - first.width : first.left);
    EXPECT_EQ(box.top, at_bottom ? 480 - first.top - first.height : first.top);
    EXPECT_EQ(box.width, first.width);
    EXPECT_EQ(box.height, first.height);
  }
}

TEST(Legend, LetsThePictureShowThrough) {
  Picture dark(640, 480, black), light(640, 480, white);
  for (Picture* picture : {&dark, &light}) draw_legend(*picture, entries_of(1, "x"), Corner::top_left);
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
  for (const std::uint32_t size : {1u, 7u, 30u})
    with_legend(size, size, entries_of(5, "panel"), Corner::bottom_right);
}

}  // namespace
}  // namespace mssim
