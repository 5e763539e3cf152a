#include "commands/shared/picture_choice.h"

#include <gtest/gtest.h>

namespace mssim {
namespace {

TEST(TwoNumbers, AreWholeAndNotTooLarge) {
  EXPECT_EQ(two_numbers("640x480", 2048), (std::pair<std::uint32_t, std::uint32_t>{640, 480}));
  for (const char* text : {"", "x", "640", "640x", "x480", "0x1", "1x0", "-1x1", "2049x1", "1x2049", "1.5x2",
                           "1x2x3", "1X2", " 1x2"})
    EXPECT_FALSE(two_numbers(text, 2048)) << text;
}

}  // namespace
}  // namespace mssim
