#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "picture/picture.h"
#include "tests/support/picture_content.h"

namespace mssim {
namespace {

constexpr Rgb colours[] = {{200, 10, 10}, {10, 200, 10}, {10, 10, 200}};

std::vector<CaptionedPicture> three(const std::string& caption) {
  std::vector<CaptionedPicture> cells;
  for (const Rgb colour : colours) cells.push_back({Picture(80, 60, colour), caption});
  return cells;
}

TEST(Sheet, PutsPicturesInRowsWithMargins) {
  const Picture sheet = sheet_of(three(""), 2);
  const PixelBox a = box_of_colour(sheet, colours[0]).value(), b = box_of_colour(sheet, colours[1]).value(),
                 c = box_of_colour(sheet, colours[2]).value();
  for (const PixelBox& box : {a, b, c}) {
    EXPECT_EQ(box.width, 80);
    EXPECT_EQ(box.height, 60);
  }
  const int margin = a.left;
  EXPECT_GT(margin, 5);
  EXPECT_EQ(a.top, margin);
  EXPECT_EQ(b.left, a.left + 80 + margin);
  EXPECT_EQ(b.top, a.top);
  EXPECT_EQ(c.left, a.left);
  EXPECT_EQ(c.top, a.top + 60 + margin);
  EXPECT_EQ(sheet.width, 2u * 80 + 3 * static_cast<unsigned>(margin));
  EXPECT_EQ(sheet.height, 2u * 60 + 3 * static_cast<unsigned>(margin));
  EXPECT_EQ(sheet.at(0, 0), white);
}

TEST(Sheet, HasNoMoreColumnsThanPictures) {
  EXPECT_EQ(sheet_of(three(""), 7), sheet_of(three(""), 3));
  EXPECT_GT(sheet_of(three(""), 1).height, 180u);
}

TEST(Sheet, WritesCaptionsBelowTheirPictures) {
  const Picture sheet = sheet_of(three("10 s"), 2);
  const PixelBox a = box_of_colour(sheet, colours[0]).value(), c = box_of_colour(sheet, colours[2]).value();
  const Picture bare = sheet_of(three(""), 2);
  EXPECT_GT(sheet.height, bare.height + 20);
  const auto is_letter = [](Rgb pixel) { return pixel.red < 80 && pixel.green < 80 && pixel.blue < 80; };
  const PixelBox letters = box_of(sheet, is_letter).value();
  EXPECT_GT(letters.top, a.top + a.height);
  Picture first_row(sheet.width, static_cast<std::uint32_t>(c.top));
  paste(first_row, sheet, 0, 0);
  const PixelBox first_letters = box_of(first_row, is_letter).value();
  EXPECT_LT(first_letters.top + first_letters.height, c.top);
  // A picture beside it has the same caption, so that they are centred together.
  EXPECT_NEAR(first_letters.left + 0.5 * first_letters.width, 0.5 * sheet.width, 2);
}

TEST(Sheet, ShortensLongCaptions) {
  std::vector<CaptionedPicture> cells = three(std::string(200, 'n'));
  const Picture sheet = sheet_of(cells, 1);
  const PixelBox ink = ink_of(sheet).value();
  EXPECT_EQ(ink.width, 80);
}

TEST(Sheet, RefusesWhatIsNoSheet) {
  EXPECT_THROW(sheet_of({}, 2), std::invalid_argument);
  EXPECT_THROW(sheet_of(three(""), 0), std::invalid_argument);
  std::vector<CaptionedPicture> cells = three("");
  cells.push_back({Picture(80, 61), ""});
  EXPECT_THROW(sheet_of(cells, 2), std::invalid_argument);
}

}  // namespace
}  // namespace mssim
