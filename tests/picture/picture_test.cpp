#include "picture/picture.h"

#include <webp/demux.h>

#include "picture/lettering.h"
#include "picture/movie.h"
#include "tests/support/picture_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

constexpr Rgb red{200, 0, 0}, blue{0, 0, 200};

std::size_t pixels_of(const Picture& picture, Rgb colour) {
  return static_cast<std::size_t>(std::ranges::count(picture.pixels, colour));
}

TEST(Picture, StoresRowsFromTheTop) {
  Picture picture(3, 2, black);
  picture.at(2, 1) = red;
  EXPECT_EQ(picture.pixels, (std::vector<Rgb>{black, black, black, black, black, red}));
}

TEST(Picture, BlendsByCoverage) {
  EXPECT_EQ(blended(red, blue, 0), red);
  EXPECT_EQ(blended(red, blue, 255), blue);
  EXPECT_EQ(blended(black, white, 100), (Rgb{100, 100, 100}));
  EXPECT_EQ(blended(white, black, 51), (Rgb{204, 204, 204}));
}

TEST(Picture, FillsWhatLiesInside) {
  Picture picture(5, 4, black);
  fill(picture, {1, 2, 2, 1}, red);
  EXPECT_EQ(picture.at(1, 2), red);
  EXPECT_EQ(picture.at(2, 2), red);
  EXPECT_EQ(pixels_of(picture, red), 2u);
  fill(picture, {-3, -3, 4, 5}, blue);
  EXPECT_EQ(picture.at(0, 1), blue);
  EXPECT_EQ(pixels_of(picture, blue), 2u);
  fill(picture, {4, 3, 2'000'000'000, 2'000'000'000}, blue);
  EXPECT_EQ(picture.at(4, 3), blue);
  EXPECT_EQ(pixels_of(picture, blue), 3u);
  for (const PixelBox& nothing :
       {PixelBox{5, 0, 1, 1}, {0, 4, 1, 1}, {-1, 0, 1, 1}, {1, 1, -1, 2}, {1, 1, 0, 2}})
    fill(picture, nothing, white);
  EXPECT_EQ(pixels_of(picture, white), 0u);
}

TEST(Picture, BlendsSinglePixelsInside) {
  Picture picture(2, 2, black);
  fill(picture, {1, 0, 1, 1}, white, 100);
  fill(picture, {2, 0, 1, 1}, white, 100);
  fill(picture, {0, -1, 1, 1}, white, 100);
  EXPECT_EQ(picture.at(1, 0), (Rgb{100, 100, 100}));
  EXPECT_EQ(pixels_of(picture, black), 3u);
}

TEST(Picture, PastesWhatLiesInside) {
  Picture pasted(2, 2, red);
  pasted.at(1, 1) = blue;
  Picture picture(4, 3, black);
  paste(picture, pasted, 1, 1);
  EXPECT_EQ(picture.at(1, 1), red);
  EXPECT_EQ(picture.at(2, 2), blue);
  EXPECT_EQ(pixels_of(picture, black), 8u);
  picture = Picture(4, 3, black);
  paste(picture, pasted, -1, -1);
  EXPECT_EQ(picture.at(0, 0), blue);
  EXPECT_EQ(pixels_of(picture, black), 11u);
  paste(picture, pasted, 3, 2);
  EXPECT_EQ(picture.at(3, 2), red);
  for (const int outside : {-2, 4, 1'000'000}) paste(picture, pasted, outside, 0);
  EXPECT_EQ(pixels_of(picture, black), 10u);
}

TEST(Png, HoldsThePicture) {
  const Picture picture = coloured_picture(37, 21, 1);
  EXPECT_EQ(decoded(png_of(picture)), picture);
  EXPECT_EQ(decoded(png_of(Picture(1, 1, Rgb{1, 2, 3}))), Picture(1, 1, Rgb{1, 2, 3}));
}

TEST(Png, SaysThatItsColoursAreSrgb) {
  const std::string png = png_of(coloured_picture(5, 4, 1));
  EXPECT_LT(png.find("sRGB"), png.find("IDAT"));
}

TEST(Png, RefusesAPictureWithoutPixels) {
  EXPECT_EQ(sentence_of<std::runtime_error>([] { png_of(Picture(0, 3)); }),
            "a picture of 0 x 3 pixels cannot be written as PNG: Invalid IHDR data");
}

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
  const PixelBox a = box_of_colour(sheet, colours[0]).value();
  EXPECT_GT(sheet.height, sheet_of(three(""), 2).height + 20);
  const auto is_letter = [](Rgb pixel) { return pixel.red < 80 && pixel.green < 80 && pixel.blue < 80; };
  const PixelBox letters = box_of(sheet, is_letter).value();
  EXPECT_GT(letters.top, a.top + a.height);
  const PixelBox centred = box_of(sheet_of(three("10 s"), 1), is_letter).value();
  EXPECT_NEAR(centred.left + centred.width / 2.0, a.left + a.width / 2.0, 2);
}

TEST(Sheet, WritesLargerWhereMorePicturesStandInARow) {
  const auto height_of_letters = [](std::uint32_t columns) {
    return ink_of(sheet_of(std::vector<CaptionedPicture>(columns, {Picture(320, 60), "H"}), columns))
        .value()
        .height;
  };
  EXPECT_GE(height_of_letters(4), 15) << "0.73 of 1.7 % of 1280 pixels";
  EXPECT_LT(height_of_letters(1), 10);
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

/// What libwebp reads of a movie.
struct ReadMovie {
  WebPAnimInfo info{};
  std::vector<Picture> frames;
  std::vector<int> ends_ms;  ///< when each frame is over
};

ReadMovie read(const std::string& bytes) {
  const WebPData data{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  const std::unique_ptr<WebPAnimDecoder, void (*)(WebPAnimDecoder*)> decoder(
      WebPAnimDecoderNew(&data, nullptr), WebPAnimDecoderDelete);
  ReadMovie movie;
  if (!decoder || !WebPAnimDecoderGetInfo(decoder.get(), &movie.info)) {
    ADD_FAILURE() << "no WebP";
    return movie;
  }
  while (WebPAnimDecoderHasMoreFrames(decoder.get())) {
    std::uint8_t* rgba = nullptr;
    int end_ms = 0;
    EXPECT_TRUE(WebPAnimDecoderGetNext(decoder.get(), &rgba, &end_ms));
    Picture& frame = movie.frames.emplace_back(movie.info.canvas_width, movie.info.canvas_height);
    for (std::size_t i = 0; i < frame.pixels.size(); ++i)
      frame.pixels[i] = {rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2]};
    movie.ends_ms.push_back(end_ms);
  }
  return movie;
}

/// A picture with a smooth run of colours, other ones for each `seed`.
Picture smooth_picture(std::uint32_t width, std::uint32_t height, unsigned seed) {
  Picture picture(width, height);
  for (unsigned y = 0; y < height; ++y)
    for (unsigned x = 0; x < width; ++x)
      picture.at(x, y) = {static_cast<std::uint8_t>(255 * x / width),
                          static_cast<std::uint8_t>(255 * y / height), static_cast<std::uint8_t>(60 * seed)};
  return picture;
}

std::vector<int> ends_at(double frames_per_second) {
  Movie movie(frames_per_second);
  for (unsigned frame = 0; frame < 4; ++frame) movie.add(smooth_picture(16, 16, frame));
  return read(movie.take_bytes()).ends_ms;
}

TEST(Movie, HoldsEveryFrameAndRepeatsForEver) {
  Movie movie(25);
  for (unsigned frame = 0; frame < 4; ++frame) movie.add(smooth_picture(301, 203, frame));
  const ReadMovie found = read(movie.take_bytes());
  EXPECT_EQ(found.info.loop_count, 0U) << "for ever";
  ASSERT_EQ(found.frames.size(), 4U);
  for (unsigned frame = 0; frame < 4; ++frame) {
    const Picture wanted = smooth_picture(301, 203, frame);
    ASSERT_EQ(found.frames[frame].pixels.size(), wanted.pixels.size());
    double difference = 0;
    for (std::size_t i = 0; i < wanted.pixels.size(); ++i) {
      const Rgb a = wanted.pixels[i], b = found.frames[frame].pixels[i];
      difference += std::abs(a.red - b.red) + std::abs(a.green - b.green) + std::abs(a.blue - b.blue);
    }
    EXPECT_LT(difference / static_cast<double>(3 * wanted.pixels.size()), 2) << "levels, of frame " << frame;
  }
}

TEST(Movie, RunsAtItsSpeed) {
  EXPECT_THAT(ends_at(30), ElementsAre(33, 67, 100, 133)) << "no rounding adds up";
  EXPECT_THAT(ends_at(1000), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(ends_at(0.1), ElementsAre(10'000, 20'000, 30'000, 40'000));
  for (const double wrong : {0.0, -1.0, 0.09, 1001.0, std::nan("")})
    EXPECT_THROW(Movie{wrong}, std::invalid_argument) << wrong;
}

TEST(Movie, RefusesWhatIsNone) {
  EXPECT_THROW(Movie(10).take_bytes(), std::logic_error);
  EXPECT_THROW(Movie(10).add(Picture()), std::runtime_error);
  EXPECT_THROW(Movie(10).add(Picture(20'000, 1)), std::runtime_error);
  Movie movie(10);
  movie.add(Picture(4, 4));
  EXPECT_THROW(movie.add(Picture(4, 5)), std::invalid_argument);
  EXPECT_NE(movie.take_bytes(), "");
  EXPECT_THROW(movie.take_bytes(), std::logic_error);
}

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
