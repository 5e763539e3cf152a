#include "charts/chart_text.h"

#include <gmock/gmock.h>

#include "text/text.h"

namespace mssim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ChartText, IsOneLineOfCharactersThatXmlMayHave) {
  EXPECT_EQ(shown_text("a\nb\tc", 80), "a b c");
  EXPECT_EQ(shown_text("\x1b[0m \xff \xEF\xBF\xBF", 80), "\\x1b[0m \\xff \uFFFD");
  EXPECT_EQ(shown_text("", 80), "");
}

TEST(ChartText, IsCutBetweenCharacters) {
  EXPECT_EQ(shown_text("äöü−", 4), "äöü−");
  EXPECT_EQ(shown_text("äöü−ß", 4), "äöü…");
  EXPECT_EQ(width_of("äöü−ß"), 5U);
}

TEST(ChartText, ChineseCharactersAreWide) {
  EXPECT_EQ(width_of("漢字ok"), 6U);
  EXPECT_EQ(shown_text("漢字漢字", 8), "漢字漢字");
  EXPECT_EQ(shown_text("漢字漢字", 7), "漢字漢…");
  EXPECT_THAT(shown_lines("漢字漢字", 4), ElementsAre("漢字", "漢字"));
}

TEST(ChartText, LinesBreakAtSpaces) {
  EXPECT_THAT(shown_lines("one two three", 8), ElementsAre("one two", "three"));
  EXPECT_THAT(shown_lines("one two three", 7), ElementsAre("one two", "three"));
  EXPECT_THAT(shown_lines("äöüäöüäöü", 4), ElementsAre("äöüä", "öüäö", "ü"));
  EXPECT_THAT(shown_lines("a b c d e f", 1), ElementsAre("a", "b", "…"));
  EXPECT_THAT(shown_lines("", 8), IsEmpty());
}

TEST(ChartText, IsOneTextForGnuplotAndForXml) {
  EXPECT_EQ(gnuplot_text("'; system('x') #"), "'''; system(''x'') #'");
  EXPECT_EQ(xml_text("<a b=\"c\">&lt;"), "&lt;a b=&quot;c&quot;&gt;&amp;lt;");
}

}  // namespace
}  // namespace mssim
