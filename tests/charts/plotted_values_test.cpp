#include "charts/plotted_values.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace mssim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Chart chart_of(Series series) {
  Chart chart;
  chart.series = {std::move(series)};
  return chart;
}

TEST(PlottedValues, LeavesOutWhatIsNoNumberAndSaysSo) {
  const PlottedValues values = plotted_values(
      chart_of({.name = "a", .x = {1, 2, 3, infinity, 5}, .y = {-1, not_a_number, 0, 4, 1e301}}));
  ASSERT_EQ(values.series[0].size(), 2U);
  EXPECT_EQ(values.series[0][0].y, -1);
  EXPECT_FALSE(values.series[0][0].after_gap);
  EXPECT_EQ(values.series[0][1].x, 3);
  EXPECT_TRUE(values.series[0][1].after_gap);
  EXPECT_THAT(values.notes, ElementsAre("3 of 5 values of \"a\" cannot be drawn: not finite numbers"));
}

TEST(PlottedValues, LogarithmicAxesHavePositiveNumbersOnly) {
  Chart chart = chart_of({.name = "a", .x = {0, 2, 3, 4}, .y = {1, -1, 0, 5}});
  chart.x.logarithmic = chart.y.logarithmic = true;
  const PlottedValues values = plotted_values(chart);
  ASSERT_EQ(values.series[0].size(), 1U);
  EXPECT_EQ(values.series[0][0].y, 5);
  EXPECT_FALSE(values.series[0][0].after_gap) << "nothing stands before it";
  EXPECT_THAT(values.notes,
              ElementsAre(HasSubstr("3 of 4 values of \"a\" cannot be drawn on a logarithmic axis")));
}

TEST(PlottedValues, AnIntervalIsLeftOutAlone) {
  Chart chart = chart_of({.name = "a",
                          .x = {1, 2, 3, 4},
                          .y = {1, 1, 1, 1},
                          .low = {0.5, 0, 2, not_a_number},
                          .high = {2, 2, 1, 2}});
  chart.y.logarithmic = true;
  const PlottedValues values = plotted_values(chart);
  ASSERT_EQ(values.series[0].size(), 4U);
  EXPECT_TRUE(values.series[0][0].interval);
  for (const int i : {1, 2, 3}) EXPECT_FALSE(values.series[0][static_cast<std::size_t>(i)].interval) << i;
  EXPECT_THAT(values.notes, ElementsAre(HasSubstr("3 of 4 intervals of \"a\"")));
  EXPECT_EQ(values.y_range().low, 0.5);
  EXPECT_EQ(values.y_range().high, 2);
}

TEST(PlottedValues, ASeriesWithoutValuesIsSaid) {
  const PlottedValues values = plotted_values(chart_of({.name = "a\n\"b\""}));
  EXPECT_TRUE(values.empty());
  EXPECT_THAT(values.notes, ElementsAre(HasSubstr("has no values")));
  EXPECT_THAT(plotted_values(chart_of({.name = "a", .x = {1}, .y = {1}})).notes, IsEmpty());
}

TEST(PlottedValues, BarsStandInTheirGroups) {
  Chart chart = chart_of({.name = "a", .y = {7, not_a_number, 9}});
  chart.form = ChartForm::bars;
  chart.groups = {"p", "q", "r"};
  const PlottedValues values = plotted_values(chart);
  ASSERT_EQ(values.series[0].size(), 2U);
  EXPECT_EQ(values.series[0][1].x, 2);
}

TEST(PlottedValues, NumbersOfValuesMustAgree) {
  EXPECT_THROW(plotted_values(chart_of({.name = "a", .x = {1, 2}, .y = {1}})), std::invalid_argument);
  EXPECT_THROW(plotted_values(chart_of({.name = "a", .x = {1}, .y = {1}, .low = {1}})),
               std::invalid_argument);
  EXPECT_THROW(plotted_values(chart_of({.name = "a", .x = {1}, .y = {1}, .low = {}, .high = {1, 2}})),
               std::invalid_argument);
  Chart bars = chart_of({.name = "a", .y = {1}});
  bars.form = ChartForm::bars;
  EXPECT_THROW(plotted_values(bars), std::invalid_argument);
}

}  // namespace
}  // namespace mssim
