#include "charts/layout.h"

#include "tests/support/testing.h"
#include "text/text.h"

namespace mssim {
namespace {

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
  EXPECT_EQ(range_of(chart)->y.low, 0.5);
  EXPECT_EQ(range_of(chart)->y.high, 2);
}

TEST(PlottedValues, ASeriesWithoutValuesIsSaid) {
  const PlottedValues values = plotted_values(chart_of({.name = "a\n\"b\""}));
  EXPECT_THAT(values.series, ElementsAre(IsEmpty()));
  EXPECT_THAT(values.notes, ElementsAre(HasSubstr("has no values")));
  EXPECT_THAT(plotted_values(chart_of({.name = "a", .x = {1}, .y = {1}})).notes, IsEmpty());
}

TEST(PlottedValues, NumbersOfValuesMustAgree) {
  EXPECT_THROW(plotted_values(chart_of({.name = "a", .x = {1, 2}, .y = {1}})), std::invalid_argument);
  EXPECT_THROW(plotted_values(chart_of({.name = "a", .x = {1}, .y = {1}, .low = {1}})),
               std::invalid_argument);
  EXPECT_THROW(plotted_values(chart_of({.name = "a", .x = {1}, .y = {1}, .low = {}, .high = {1, 2}})),
               std::invalid_argument);
}

/// WCAG 2.2: https://www.w3.org/TR/WCAG22/#dfn-relative-luminance
double luminance(std::string_view colour) {
  double sum = 0;
  const std::array<double, 3> weights{0.2126, 0.7152, 0.0722};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const double value = std::stoi(std::string(colour.substr(1 + 2 * channel, 2)), nullptr, 16) / 255.0;
    sum += weights[channel] * (value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
  }
  return sum;
}

TEST(SeriesLook, ColoursAreSeenOnWhiteAndOnNearBlack) {
  EXPECT_NEAR(luminance("#ffffff"), 1, 1e-12);
  for (const std::string_view colour : series_colours) {
    EXPECT_GE(1.05 / (luminance(colour) + 0.05), 3) << colour;
    for (const std::string_view page : {"#000000", "#121212", "#0d1117", "#161b22"})
      EXPECT_GE((luminance(colour) + 0.05) / (luminance(page) + 0.05), 3) << colour << " on " << page;
  }
}

TEST(SeriesLook, NoTwoColoursAreTheSame) {
  EXPECT_EQ(std::set(series_colours.begin(), series_colours.end()).size(), series_colours.size());
}

TEST(SeriesLook, AFamilyDiffersByOriginAlone) {
  const std::vector<Series> series{{.name = "a", .origin = Origin::published, .family = "gpu"},
                                   {.name = "b", .family = "cpu"},
                                   {.name = "c", .family = "gpu"},
                                   {.name = "d", .family = "gpu"},
                                   {.name = "e"}};
  const auto looks = looks_of(series);
  EXPECT_EQ(looks[0], looks[2]);
  EXPECT_NE(looks[3], looks[2]) << "two measured ones must not look alike";
  EXPECT_NE(looks[1], looks[0]);
}

TEST(SeriesLook, AFixedFamilyLooksTheSameInEveryChart) {
  const std::vector<std::string> fixed{"serial", "openmp", "opencl"};
  const std::vector<Series> one{{.name = "a", .family = "opencl"}, {.name = "b", .family = "mine"}};
  const std::vector<Series> other{
      {.name = "c", .family = "mine"}, {.name = "d", .family = "serial"}, {.name = "e", .family = "opencl"}};
  EXPECT_EQ(looks_of(one, fixed)[0], 2U);
  EXPECT_EQ(looks_of(one, fixed)[1], 3U);
  EXPECT_EQ(looks_of(other, fixed)[2], 2U);
  EXPECT_EQ(looks_of(other, fixed)[1], 0U);
}

TEST(SeriesLook, NoTwoOfAHundredSeriesOfOneOriginShareIt) {
  std::vector<Series> series;
  for (int i = 0; i < 100; ++i)
    series.push_back(
        {.name = "", .origin = Origin{i % 3}, .family = i % 7 ? "f" + std::to_string(i % 5) : ""});
  const std::vector<std::size_t> looks = looks_of(series);
  std::set<std::pair<std::size_t, Origin>> seen;
  for (std::size_t i = 0; i < series.size(); ++i)
    EXPECT_TRUE(seen.emplace(looks[i], series[i].origin).second);
}

TEST(SeriesLook, MarksTakeNoLookOfOthers) {
  const std::vector<Series> lines{{.name = "a"}, {.name = "roof", .origin = Origin::reference}};
  std::vector<Series> with_marks = lines;
  with_marks.insert(with_marks.begin(),
                    {.name = "front", .origin = Origin::reference, .mark = PointMark::ring});
  EXPECT_EQ(looks_of(with_marks)[1], looks_of(lines)[0]);
  EXPECT_EQ(looks_of(with_marks)[2], looks_of(lines)[1]);
}

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

std::vector<std::string> labels_of(const AxisScale& scale) {
  std::vector<std::string> labels;
  for (const Tick& tick : scale.ticks) labels.push_back(tick.label);
  return labels;
}

TEST(AxisScale, LogarithmicTicksArePowersOfTen) {
  EXPECT_THAT(labels_of(logarithmic_scale(0.005, 3000)),
              ElementsAre("0.01", "0.1", "1", "10", "100", "1,000"));
}

TEST(AxisScale, LogarithmicTicksAreCloserWhereThereAreFewPowers) {
  EXPECT_THAT(labels_of(logarithmic_scale(2500, 350000)),
              ElementsAre("3,000", "10,000", "30,000", "100,000", "300,000"));
  EXPECT_THAT(labels_of(logarithmic_scale(1.5, 9)), ElementsAre("2", "5", "10"));
  EXPECT_GE(logarithmic_scale(4.1, 4.2).ticks.size(), 2U);
}

TEST(AxisScale, LargeAndSmallPowersAreWrittenAsSuch) {
  EXPECT_THAT(labels_of(logarithmic_scale(2e-9, 3e-6)), ElementsAre("10⁻⁸", "10⁻⁷", "10⁻⁶"));
  EXPECT_THAT(labels_of(logarithmic_scale(2e10, 9e10)), ElementsAre("2·10¹⁰", "5·10¹⁰", "10¹¹"));
}

TEST(AxisScale, ZeroIsShownWhereItIsNear) {
  EXPECT_EQ(linear_scale(1, 10).low, 0);
  EXPECT_EQ(linear_scale(4.9, 10).low, 0);
  EXPECT_GT(linear_scale(5.1, 10).low, 4);
  EXPECT_LT(linear_scale(9, 10).low, 9);
  EXPECT_GT(linear_scale(9, 10).low, 0);
  EXPECT_EQ(linear_scale(-10, -1).high, 0);
}

TEST(AxisScale, AValueStandsAtItsFraction) {
  EXPECT_DOUBLE_EQ((AxisScale{-10, 30, {}}).fraction(0), 0.25);
  EXPECT_DOUBLE_EQ((AxisScale{0.01, 100, {}, true}).fraction(0.1), 0.25);
}

TEST(AxisScale, EachPairOfValuesHasRoomAndTicks) {
  using Scale = AxisScale (*)(double, double);
  const std::vector<double> values{1 / largest_plotted, 1e-9, 0.1, 1, 1 + 1e-12, 3, 1e5, largest_plotted};
  for (const Scale scale : {Scale{linear_scale}, Scale{logarithmic_scale}})
    for (const double low : values)
      for (const double high : values) {
        if (low > high) continue;
        const AxisScale made = scale(low, high);
        EXPECT_TRUE(std::isfinite(made.low) && std::isfinite(made.high)) << low << ' ' << high;
        EXPECT_LT(made.low, made.high) << low << ' ' << high;
        EXPECT_LE(made.low, low);
        EXPECT_GE(made.high, high);
        EXPECT_FALSE(made.ticks.empty()) << low << ' ' << high;
        EXPECT_LE(made.ticks.size(), 9U) << low << ' ' << high;
        for (const Tick& tick : made.ticks) {
          EXPECT_LE(made.low, tick.value * (1 + 1e-8));
          EXPECT_GE(made.high * (1 + 1e-8), tick.value);
        }
      }
  for (const auto& [low, high] : {std::pair{0.0, 0.0}, {-1.0, 1.0}, {-largest_plotted, largest_plotted}}) {
    EXPECT_LT(linear_scale(low, high).low, linear_scale(low, high).high);
    EXPECT_GE(linear_scale(low, high).ticks.size(), 2U);
  }
}

ChartLayout layout_with_ticks_at(const std::vector<double>& along) {
  Chart chart = chart_of({.name = "a", .x = along, .y = along});
  chart.x = {.label = "nodes", .logarithmic = true, .ticks_at_values = true};
  return chart_layout(chart, plotted_values(chart)).value();
}

TEST(ChartLayout, TicksAtValuesAreTheValues) {
  const ChartLayout layout = layout_with_ticks_at({2500, 4900, 10000, 40000, 200000, 350000});
  EXPECT_THAT(labels_of(layout.x), ElementsAre("2,500", "4,900", "10,000", "40,000", "200,000", "350,000"));
  EXPECT_THAT(layout.tick_rows, testing::Each(testing::Ne(std::nullopt))) << "all are named";
}

TEST(ChartLayout, LabelsThatStandTooCloseTakeTurns) {
  EXPECT_THAT(layout_with_ticks_at({100, 1000, 10000}).tick_rows, ElementsAre(0, 0, 0));
  EXPECT_THAT(layout_with_ticks_at({1000, 9000, 10000}).tick_rows, ElementsAre(0, 1, 0));
  EXPECT_THAT(layout_with_ticks_at({1000, 9800, 9900, 10000}).tick_rows, ElementsAre(0, 1, std::nullopt, 0));
  EXPECT_GT(layout_with_ticks_at({1000, 9000, 10000}).height, layout_with_ticks_at({1000, 10000}).height);
}

TEST(ChartLayout, LongNamesTakeSeveralLinesOfTheLegend) {
  Chart chart = chart_of({.name = "short", .x = {1}, .y = {1}});
  const double height = chart_layout(chart, plotted_values(chart)).value().height;
  const std::string name = "Multi-thread CPU, Nexus 7, published in 2016, slope 0.89";
  chart.series.insert(chart.series.begin(), {.name = name, .x = {1}, .y = {1}});
  const ChartLayout layout = chart_layout(chart, plotted_values(chart)).value();
  const std::vector<std::string>& lines = layout.legend.at(0).lines;
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_EQ(lines[0] + " " + lines[1], name);
  EXPECT_EQ(layout.legend[1].middle - layout.legend[0].middle, legend_row + line_height);
  EXPECT_EQ(layout.height - height, legend_row + line_height);
}

TEST(ChartLayout, ShortNamesStandInTwoColumnsOfTheLegend) {
  Chart chart = chart_of({.name = "a", .x = {1}, .y = {1}});
  for (const char* name : {"nothing to show", "b", "c"}) chart.series.push_back({.name = name});
  for (const std::size_t shown : {2U, 3U}) chart.series[shown].x = chart.series[shown].y = {1};
  const std::vector<SeriesEntry> legend = chart_layout(chart, plotted_values(chart)).value().legend;
  EXPECT_EQ(legend.at(2).left, legend[0].left);
  EXPECT_EQ(legend[2].middle - legend[0].middle, legend_row);
  EXPECT_GT(legend.at(3).left, chart_width / 2 - 1);
  EXPECT_EQ(legend[3].middle, legend[0].middle);
}

TEST(ChartLayout, HasASubtitleBelowTheTitle) {
  Chart chart = chart_of({.name = "a", .x = {1}, .y = {1}});
  chart.title = "title";
  const ChartLayout without = chart_layout(chart, plotted_values(chart)).value();
  chart.subtitle = "Measured on A Processor";
  const ChartLayout with = chart_layout(chart, plotted_values(chart)).value();
  EXPECT_THAT(with.subtitle, ElementsAre("Measured on A Processor"));
  EXPECT_EQ(with.top - without.top, line_height);
}

}  // namespace
}  // namespace mssim
