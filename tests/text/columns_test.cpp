#include <gtest/gtest.h>

#include "text/text.h"

namespace mssim {
namespace {

TEST(Columns, CountCharactersOfUtf8) {
  EXPECT_EQ(width_of(""), 0U);
  EXPECT_EQ(width_of("1.00× ▏✓"), 8U);
  EXPECT_EQ(width_of("あ日😀"), 6U);
}

TEST(Columns, ClipBetweenCharacters) {
  EXPECT_EQ(clipped("a×b", 2), "a×");
  EXPECT_EQ(clipped("a×b", 1), "a");
  EXPECT_EQ(clipped("a×b", 0), "");
  EXPECT_EQ(clipped("a×b", 3), "a×b");
  EXPECT_EQ(clipped("a×b", 4), "a×b");
}

TEST(Columns, WrapBetweenWords) {
  EXPECT_EQ(wrapped("one two three four", 9, ""), "one two\nthree\nfour");
  EXPECT_EQ(wrapped("one two three four", 9, "  "), "one two\n  three\n  four");
  EXPECT_EQ(wrapped("antidisestablishment is long", 10, ""), "antidisestablishment\nis long");
  EXPECT_EQ(wrapped("× × ×", 3, ""), "× ×\n×");
  EXPECT_EQ(wrapped("one line", 8, ""), "one line");
  EXPECT_EQ(wrapped("", 8, ""), "");
}

TEST(Bar, HasEighthsWithUtf8) {
  EXPECT_EQ(bar(1, 2, true), "██");
  EXPECT_EQ(bar(0.5, 2, true), "█");
  EXPECT_EQ(bar(9.0 / 16, 2, true), "█▏");
  EXPECT_EQ(bar(15.0 / 16, 2, true), "█▉");
}

TEST(Bar, HasWholeSignsWithoutUtf8) {
  EXPECT_EQ(bar(1, 4, false), "####");
  EXPECT_EQ(bar(0.6, 4, false), "##");
}

TEST(Bar, ShowsWhatIsAboveZeroAndNoMoreThanAll) {
  EXPECT_EQ(bar(1e-6, 10, true), "▏");
  EXPECT_EQ(bar(1e-6, 10, false), "#");
  EXPECT_EQ(bar(0, 10, true), "");
  EXPECT_EQ(bar(1.5, 2, false), "##");
}

}  // namespace
}  // namespace mssim
