#include <gtest/gtest.h>

#include "render/draw.h"

namespace mssim {
namespace {

TEST(Srgb, GivesEveryColourBack) {
  for (int code = 0; code < 256; ++code) {
    const auto channel = static_cast<std::uint8_t>(code);
    const Rgb colour{channel, static_cast<std::uint8_t>(255 - code), 128};
    EXPECT_EQ(colour_of(light_of(colour)), colour) << code;
  }
}

TEST(Srgb, HasAFifthOfTheLightInTheMiddle) {
  EXPECT_NEAR(light_of({128, 128, 128}).x, 0.2159F, 1e-4F);  // IEC 61966-2-1
  EXPECT_EQ(light_of(white).y, 1);
  EXPECT_EQ(light_of(black).z, 0);
}

TEST(Srgb, CutsOffWhatIsBrighterThanWhite) { EXPECT_EQ(colour_of({2, -1, 1}), (Rgb{255, 0, 255})); }

}  // namespace
}  // namespace mssim
