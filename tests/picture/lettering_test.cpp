#include "picture/lettering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "picture/glyph_raster.h"
#include "picture/glyph_table.h"
#include "tests/support/picture_content.h"

namespace mssim {
namespace {

/// A text at 14 px on white, 10 px from the left, on a baseline of 20 px.
Picture written(std::string_view text, double size_px = 14) {
  Picture picture(static_cast<std::uint32_t>(text_width(text, {size_px}) + 20), 30);
  draw_text(picture, text, 10, 20, {size_px});
  return picture;
}

TEST(Lettering, KnowsEveryCharacterThatItPromises) {
  const auto box = mask_of(glyph_of(U'\u4e16'), Pen(20)).coverage;
  std::u32string characters = U"°×–−µ±·²³…";
  for (char32_t c = ' '; c <= '~'; ++c) characters += c;
  for (const char32_t c : characters) {
    EXPECT_EQ(glyph_of(c).character, c);
    EXPECT_NE(mask_of(glyph_of(c), Pen(20)).coverage, box) << static_cast<unsigned>(c);
  }
}

TEST(Lettering, TablesAreInOrderAndDrawNoTwoCharactersAlike) {
  std::map<std::string, char32_t> drawn;
  for (const auto table : {letter_glyphs, sign_glyphs}) {
    EXPECT_TRUE(std::ranges::is_sorted(table, {}, &Glyph::character));
    for (const Glyph& glyph : table) {
      const GlyphMask mask = mask_of(glyph, Pen(12));
      std::string key(mask.coverage.begin(), mask.coverage.end());
      key += static_cast<char>(mask.height);
      key += static_cast<char>(mask.top);
      const auto [at, is_new] = drawn.try_emplace(key, glyph.character);
      // The micro sign and mu are meant to look alike.
      EXPECT_TRUE(is_new || glyph.character == U'μ')
          << static_cast<unsigned>(glyph.character) << " and " << static_cast<unsigned>(at->second);
    }
  }
}

TEST(Lettering, StandsOnTheBaselineAtTheColumnGiven) {
  const PixelBox ink = ink_of(written("H")).value();
  EXPECT_EQ(ink.left, 10 - 1) << "the pen is a little wider than a pixel";
  for (const double size : {11.0, 12.0, 20.0}) {
    const Letters letters{size};
    const Picture picture = written("I", size);
    const auto covered = [&](int x, int y) {
      return picture.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)).red < 80;
    };
    EXPECT_TRUE(covered(10, 19)) << size;
    EXPECT_FALSE(covered(10, 20)) << size;
    EXPECT_TRUE(covered(10, 20 - letters.capital_height())) << size;
    EXPECT_FALSE(covered(10, 19 - letters.capital_height())) << size;
  }
}

TEST(Lettering, StemsAndBarsFillWholePixelsAtEverySize) {
  for (double size = 10; size <= 40; size += 0.5) {
    const Pen pen(size);
    for (const char32_t c : {U'E', U'n', U'o', U'e', U'T'}) {
      const GlyphMask mask = mask_of(glyph_of(c), pen);
      const auto full =
          std::ranges::count_if(mask.coverage, [](std::uint8_t covered) { return covered > 245; });
      EXPECT_GE(full, 12 * size / 40 * pen.line) << size << ' ' << static_cast<char>(c);
    }
  }
}

TEST(Lettering, IsAsWideAsMeasured) {
  for (const double size : {10.0, 14.0, 23.5, 40.0})
    for (const std::string_view text : {"HnI", "0", "Wm", "10 N/m²"}) {
      Picture picture(400, 60);
      draw_text(picture, text, 10, 40, {size});
      EXPECT_NEAR(ink_of(picture).value().width, text_width(text, {size}), 2 + size / 20)
          << text << ' ' << size;
    }
  EXPECT_EQ(text_width("", {}), 0);
  EXPECT_EQ(text_width("0123456789", {16}), text_width("8888888888", {16})) << "digits have one width";
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

TEST(Lettering, DrawsAnEmptyBoxForEachUnknownCharacterAndStrayByte) {
  const Picture box = written("世");
  EXPECT_EQ(written("\xff"), box);
  EXPECT_EQ(written("\xc2"), box);
  EXPECT_EQ(written("\n"), box);
  EXPECT_EQ(written("\xe4\xb8"), written("世世")) << "a character that is cut off";
  EXPECT_EQ(written("a\xc2z"), written("a世z"));
  EXPECT_EQ(written("\xf0\x9f\x98\x80"), box);
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
