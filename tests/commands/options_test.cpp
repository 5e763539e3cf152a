#include "commands/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"
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

TEST(TwoNumbers, AreWholeAndNotTooLarge) {
  EXPECT_EQ(two_numbers("640x480", 2048), (std::pair<std::uint32_t, std::uint32_t>{640, 480}));
  for (const char* text : {"", "x", "640", "640x", "x480", "0x1", "1x0", "-1x1", "2049x1", "1x2049", "1.5x2",
                           "1x2x3", "1X2", " 1x2"})
    EXPECT_FALSE(two_numbers(text, 2048)) << text;
}

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ScenesIn, AreSeparatedByCommas) {
  EXPECT_THAT(names_and_files_in("cloth2500"), ElementsAre("cloth2500"));
  EXPECT_THAT(names_and_files_in("cloth2500,x.json,torus-small"),
              ElementsAre("cloth2500", "x.json", "torus-small"));
  EXPECT_THAT(names_and_files_in("cloth2500,,torus-small,"), ElementsAre("cloth2500", "torus-small"));
  EXPECT_THAT(names_and_files_in(""), IsEmpty());
  EXPECT_THAT(names_and_files_in(","), IsEmpty());
}

class ScenesInFolder : public TemporaryFolderTest {};

TEST_F(ScenesInFolder, AreNotCutWithinThePathOfAFile) {
  const std::string comma = put("a,b.json", "{}").string();
  const std::string plain = put("c.json", "{}").string();
  EXPECT_THAT(names_and_files_in(comma), ElementsAre(comma));
  EXPECT_THAT(names_and_files_in("cloth2500," + comma + "," + plain), ElementsAre("cloth2500", comma, plain));
  EXPECT_THAT(names_and_files_in(plain + "," + comma), ElementsAre(plain, comma));
  EXPECT_THAT(names_and_files_in(comma + "x"), ElementsAre((folder() / "a").string(), "b.jsonx"));
}

}  // namespace
}  // namespace mssim
