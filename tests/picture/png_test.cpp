#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "picture/picture.h"
#include "tests/support/png_fixture.h"

namespace mssim {
namespace {

TEST(Png, HoldsThePicture) {
  const Picture picture = coloured_picture(37, 21, 1);
  EXPECT_EQ(decoded(png_of(picture)), picture);
  EXPECT_EQ(decoded(png_of(Picture(1, 1, Rgb{1, 2, 3}))), Picture(1, 1, Rgb{1, 2, 3}));
}

TEST(Png, SaysThatItsColoursAreSrgb) {
  const std::vector<PngChunk> chunks = chunks_of(png_of(coloured_picture(5, 4, 1)));
  ASSERT_GE(chunks.size(), 4u);
  EXPECT_EQ(chunks[0].type, "IHDR");
  EXPECT_EQ(chunks[1].type, "sRGB");
  EXPECT_EQ(chunks.back().type, "IEND");
  for (const PngChunk& chunk : chunks) EXPECT_TRUE(chunk.sound) << chunk.type;
}

TEST(Png, IsTheSameForTheSamePicture) {
  EXPECT_EQ(png_of(coloured_picture(64, 48, 3)), png_of(coloured_picture(64, 48, 3)));
  EXPECT_NE(png_of(coloured_picture(64, 48, 3)), png_of(coloured_picture(64, 48, 4)));
}

TEST(Png, RefusesAPictureWithoutPixels) {
  try {
    png_of(Picture(0, 3));
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "a picture of 0 x 3 pixels cannot be written as PNG: Invalid IHDR data");
  }
}

}  // namespace
}  // namespace mssim
