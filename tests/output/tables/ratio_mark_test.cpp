#include <gtest/gtest.h>

#include "output/tables/results.h"

namespace mssim {
namespace {

TEST(RatioMark, StandsWhereTheTimesNameTheOtherOneAsTheFaster) {
  EXPECT_EQ(mark_of_ratio(0.923, 1.54, 1.48), "†");
  EXPECT_EQ(mark_of_ratio(1.1, 1.48, 1.54), "†");
  EXPECT_EQ(mark_of_ratio(0.95, 1.48, 1.54), "");
}

TEST(RatioMark, StandsWhereTheTimesDifferFromTheRatioByMoreThanAQuarter) {
  EXPECT_EQ(mark_of_ratio(4, 4.99, 1), "");
  EXPECT_EQ(mark_of_ratio(4, 5.02, 1), "†");
  EXPECT_EQ(mark_of_ratio(5.02, 4, 1), "†");
  EXPECT_EQ(mark_of_ratio(0.899, 1.35, 2.19), "†");
}

TEST(RatioMark, JudgesWhatIsShown) {
  EXPECT_EQ(mark_of_ratio(0.998, 1.501, 1.5), "");   // 1.50 and 1.50
  EXPECT_EQ(mark_of_ratio(0.9999, 1.52, 1.51), "");  // 1.00
}

TEST(RatioMark, IsExplainedWhereACellHasIt) {
  Table table;
  table.add({{"ratio", 2.0}});
  EXPECT_EQ(legend_of_ratios(table), "");
  EXPECT_EQ(legend_of_ratios(Document{Paragraph{"†"}, table}), "");
  table.rows[0][0].suffix = "†";
  EXPECT_TRUE(legend_of_ratios(table).starts_with("† the two times shown contradict this ratio: "));
  EXPECT_EQ(legend_of_ratios(Document{Heading{1, "Times"}, table}), legend_of_ratios(table));
}

}  // namespace
}  // namespace mssim
