#include "commands/render/sheet_choice.h"

#include <gtest/gtest.h>

namespace mssim {
namespace {

using Frames = std::vector<std::size_t>;

TEST(SpreadOver, GoesFromTheFirstToTheLast) {
  Frames frames;
  for (std::size_t i = 0; i < 31; ++i) frames.push_back(10 + i);
  EXPECT_EQ(spread_over(frames, 6), (Frames{10, 16, 22, 28, 34, 40}));
  EXPECT_EQ(spread_over(frames, 2), (Frames{10, 40}));
  EXPECT_EQ(spread_over(frames, 1), Frames{40});
  // A third and two thirds of 5 are 1.7 and 3.3.
  EXPECT_EQ(spread_over({0, 1, 2, 3, 4, 5}, 4), (Frames{0, 2, 3, 5}));
  EXPECT_EQ(spread_over(frames, 100), frames);
  const Frames chosen = spread_over(frames, 30);
  for (std::size_t i = 1; i < chosen.size(); ++i) EXPECT_LT(chosen[i - 1], chosen[i]);
}

}  // namespace
}  // namespace mssim
