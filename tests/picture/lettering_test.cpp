#include "picture/lettering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/picture_content.h"

namespace mssim {
namespace {

/// A text at 14 px on white, 10 px from the left, on a baseline of 20 px.
Picture written(std::string_view text, double size_px = 14) {
  Picture picture(static_cast<std::uint32_t>(text_width(text, {size_px}) + 20), 30);
  draw_text(picture, text, 10, 20, {size_px});
  return picture;
}

TEST(Lettering, KnowsEveryCharacterThatPicturesHave) {
  const Picture box = written("世");
  std::string characters;
  for (char c = '!'; c <= '~'; ++c) EXPECT_NE(written(std::string(1, c)), box) << c;
  for (const char* c : {"°", "×", "–", "−", "µ", "±", "·", "²", "³", "…"}) EXPECT_NE(written(c), box) << c;
  EXPECT_FALSE(ink_of(written("a")) == std::nullopt);
}

TEST(Lettering, StandsOnTheBaselineAtTheColumnGiven) {
  for (const double size : {11.0, 12.0, 14.0, 20.0}) {
    const Letters letters{size};
    const PixelBox ink = ink_of(written("H", size)).value();
    EXPECT_EQ(ink.left, 10) << size;
    EXPECT_EQ(ink.top + ink.height, 20) << size;
    EXPECT_EQ(ink.height, letters.capital_height()) << size;
    EXPECT_NEAR(ink.height, 0.729 * size, 1) << "the font's capitals";
    EXPECT_EQ(ink_of(written("g", size)).value().top + ink_of(written("g", size)).value().height,
              20 + letters.descent());
  }
}

TEST(Lettering, IsAsWideAsMeasured) {
  for (const double size : {10.0, 14.0, 23.5, 40.0})
    for (const std::string_view text : {"HnI", "0", "Wm", "10 N/m²"}) {
      Picture picture(400, 60);
      draw_text(picture, text, 10, 40, {size});
      EXPECT_EQ(ink_of(picture).value().width, text_width(text, {size})) << text << ' ' << size;
    }
  EXPECT_EQ(text_width("", {}), 0);
  EXPECT_EQ(text_width("8012345678", {16}), text_width("8888888888", {16})) << "digits have one width";
}

TEST(Lettering, AlignsLeftCentreAndRight) {
  const Letters letters{14};
  const int width = text_width("strain", letters);
  for (const auto& [alignment, left] :
       {std::pair{Alignment::left, 100}, std::pair{Alignment::centre, 100 - width / 2},
        std::pair{Alignment::right, 100 - width}}) {
    Picture aligned(200, 30), expected(200, 30);
    draw_text(aligned, "strain", 100, 20, letters, alignment);
    draw_text(expected, "strain", left, 20, letters);
    EXPECT_EQ(aligned, expected);
  }
}

TEST(Lettering, DrawsASignForEachStrayByte) {
  const Picture sign = written("\ufffd");
  EXPECT_NE(sign, written("世")) << "an empty box";
  EXPECT_EQ(written("\xff"), sign);
  EXPECT_EQ(written("\xc2"), sign);
  EXPECT_EQ(written("\xe4\xb8"), written("\ufffd\ufffd")) << "a character that is cut off";
  EXPECT_EQ(written("a\xc2z"), written("a\ufffdz"));
}

TEST(Lettering, IsWrittenInItsColourAndCutOffOutside) {
  Picture picture(20, 20, black);
  draw_text(picture, "WWW", -9, 12, {30, Rgb{10, 200, 30}});
  EXPECT_NE(std::ranges::find(picture.pixels, Rgb{10, 200, 30}), picture.pixels.end());
  draw_text(picture, "gone", 1000, -1000, {12});
}

TEST(Lettering, ShortensWhatIsTooWide) {
  const Letters letters{12};
  const std::string name = "left front trouser panel";
  const int width = text_width(name, letters);
  EXPECT_EQ(shortened(name, width, letters), name);
  std::size_t last = name.size() + 1;
  for (int narrower = width - 1; narrower > 30; narrower -= 17) {
    const std::string text = shortened(name, narrower, letters);
    EXPECT_LE(text_width(text, letters), narrower);
    EXPECT_TRUE(text.ends_with("…"));
    EXPECT_EQ(name.find(text.substr(0, text.size() - std::string("…").size())), 0u);
    EXPECT_LT(text.size(), last + 3);
    last = text.size();
  }
  EXPECT_EQ(shortened("µµµµµµ", text_width("µµ…", letters), letters), "µµ…");
  EXPECT_EQ(shortened(name, 0, letters), "");
}

}  // namespace
}  // namespace mssim
