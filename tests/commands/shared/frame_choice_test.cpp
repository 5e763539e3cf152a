#include "commands/shared/frame_choice.h"

#include <gtest/gtest.h>

#include "text/error.h"

namespace mssim {
namespace {

using Frames = std::vector<std::size_t>;

TEST(ListedFrames, AreNumbersRangesAndTheLast) {
  EXPECT_EQ(listed_frames({"0", "3-5", "last"}, 10), (Frames{0, 3, 4, 5, 9}));
  EXPECT_EQ(listed_frames({"8-last"}, 10), (Frames{8, 9}));
  EXPECT_EQ(listed_frames({"7-7"}, 10), Frames{7});
  EXPECT_EQ(listed_frames({"all"}, 3), (Frames{0, 1, 2}));
}

TEST(ListedFrames, AreRefusedWhereTheyAreNone) {
  for (const char* word :
       {"10", "0-10", "-1", "x", "", "1-", "5-3", "1.5", "1-2-3", "last-0", "all-1", "99999999999999999999"})
    EXPECT_THROW(listed_frames({word}, 10), UsageError) << word;
}

TEST(FrameAt, IsTheNearest) {
  const std::vector<double> times{0, 0.1, 0.2};
  EXPECT_EQ(frame_at(0, times), 0U);
  EXPECT_EQ(frame_at(0.14, times), 1U);
  EXPECT_EQ(frame_at(0.3, times), 2U);
  EXPECT_THROW(frame_at(0.31, times), UsageError);
  EXPECT_EQ(frame_at(0, {0.0}), 0U);
  EXPECT_THROW(frame_at(1, {0.0}), UsageError);
}

TEST(ChosenFrames, AreAllUnlessAnOptionIsGiven) {
  const std::vector<double> times{0, 0.1, 0.2};
  EXPECT_EQ(chosen_frames({}, times), (Frames{0, 1, 2}));
  EXPECT_EQ(chosen_frames({{"last", "0"}, {}}, times), (Frames{2, 0}));
  EXPECT_EQ(chosen_frames({{}, 0.11}, times), Frames{1});
}

}  // namespace
}  // namespace mssim
