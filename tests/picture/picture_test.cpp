#include "picture/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

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
  blend(picture, 1, 0, white, 100);
  blend(picture, 2, 0, white, 100);
  blend(picture, 0, -1, white, 100);
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

}  // namespace
}  // namespace mssim
