#include "charts/layout.h"
#include "platform/files.h"
#include "platform/process.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"
#include "text/text.h"

namespace mssim {
namespace {

Chart small_chart(ChartForm form) {
  Chart chart;
  chart.id = "small";
  chart.title = "Time of a step";
  chart.form = form;
  chart.subtitle = "Measured on A Processor";
  chart.x = {"nodes", true};
  chart.y = {"time of a step (ms)", true};
  const std::vector<double> nodes{2500, 10000};
  chart.series = {
      {.name = "serial",
       .origin = Origin::measured,
       .family = "cpu",
       .x = nodes,
       .y = {0.1, 0.3},
       .low = {0.09, 0.2},
       .high = {0.2, 0.4}},
      {.name = "CPU, published", .origin = Origin::published, .family = "cpu", .x = nodes, .y = {19.5, 80.5}},
      {.name = "bandwidth", .origin = Origin::reference, .x = nodes, .y = {0.01, 0.04}}};
  return chart;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t times = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at) ++times;
  return times;
}

class DrawSvg : public TemporaryFolderTest {
 protected:
  static std::string drawn(const Chart& chart) { return draw_svg(chart).svg; }

  void expect_well_formed(const std::string& svg) const {
    const auto xmllint = find_program("xmllint");
    if (!xmllint) GTEST_SKIP() << "xmllint is not installed: Debian's package libxml2-utils";
    const ChildResult ended = run({*xmllint, {"--noout", put("chart.svg", svg).string()}, {}, folder(), 10});
    EXPECT_EQ(ended.exit_code, 0) << ended.output;
  }
};

TEST_F(DrawSvg, EachFormIsWellFormedAndHasItsTexts) {
  for (const ChartForm form : {ChartForm::lines, ChartForm::points}) {
    const std::string svg = drawn(small_chart(form));
    expect_well_formed(svg);
    for (const char* text : {">Time of a step<", ">Measured on A Processor<", ">nodes<",
                             ">time of a step (ms)<", ">serial<", ">CPU, published<"})
      EXPECT_THAT(svg, HasSubstr(text));
    EXPECT_EQ(count(svg.substr(std::min(svg.size(), svg.rfind("<g "))), "L"), 1U)
        << "the reference is a line";
    EXPECT_EQ(svg.find("stroke-dasharray") != std::string::npos, form == ChartForm::lines)
        << "of the published";
  }
}

TEST_F(DrawSvg, HasNoColourOfLightPagesAndNoSize) {
  const std::string svg = drawn(small_chart(ChartForm::lines));
  EXPECT_THAT(svg, AllOf(HasSubstr("currentColor"), HasSubstr("viewBox=\"0 0 480 ")));
  for (const char* colour : {"black", "white", "#000", "#fff"})
    EXPECT_THAT(svg, Not(HasSubstr(std::string("\"") + colour))) << colour;
  EXPECT_THAT(svg.substr(0, svg.find('>')), AllOf(Not(HasSubstr(" width=")), Not(HasSubstr(" height="))));
}

TEST_F(DrawSvg, MarksAreSignsInTheColourOfTheText) {
  Chart chart = small_chart(ChartForm::lines);
  chart.remarks = {"What <crosses> are"};
  std::set<std::string> drawings;
  for (const PointMark mark : {PointMark::ring, PointMark::square, PointMark::cross}) {
    chart.series.back() = {
        .name = "a mark", .origin = Origin::reference, .x = {2500}, .y = {0.1}, .mark = mark};
    const std::string svg = drawn(chart);
    expect_well_formed(svg);
    EXPECT_THAT(svg, AllOf(HasSubstr(">a mark<"), HasSubstr("What &lt;crosses&gt; are.")));
    const std::size_t series = svg.rfind("<g ");
    EXPECT_EQ(count(svg.substr(series), "M"), 2U) << "in the legend and on the point";
    EXPECT_EQ(count(svg.substr(series), "stroke=\"currentColor\""), 1U);
    EXPECT_TRUE(drawings.insert(svg).second);
  }
}

TEST_F(DrawSvg, SixteenLinesDifferWithoutColours) {
  Chart chart = small_chart(ChartForm::lines);
  chart.series.clear();
  for (int i = 0; i < 16; ++i) chart.series.push_back({.name = "a", .x = {1, 2}, .y = {1, 2}});
  std::string svg = drawn(chart);
  EXPECT_EQ(count(svg, "stroke-dasharray"), 8U) << "from the ninth on, where shapes repeat";
  std::set<std::string> looks;
  for (std::size_t at = 0; (at = svg.find("<g ", at)) != std::string::npos;) {
    const std::string series = svg.substr(at, svg.find("</g>", at) - at);
    // The dash, and the shape of the first point on.
    const std::size_t point = series.rfind("<path"), shape = series.find('m', point);
    looks.insert((series.find("dasharray") != std::string::npos ? "dashed " : "solid ") +
                 series.substr(shape, series.find('M', shape) - shape));
    ++at;
  }
  EXPECT_EQ(looks.size(), 16U);
}

TEST_F(DrawSvg, ValuesStandWhereTheAxesSay) {
  Chart chart = small_chart(ChartForm::points);
  chart.y.logarithmic = false;
  chart.series = {{.name = "a", .x = {1, 100}, .y = {-3, 5}, .low = {-4, 5}, .high = {-3, 6}}};
  const ChartLayout layout = chart_layout(chart, plotted_values(chart)).value();
  const std::string svg = drawn(chart);
  const auto number = [](double value) { return decimal(std::round(value * 100) / 100); };
  // A tenth of the two decades on each side: 1 is at 1/12 of the axis, 100 at 11/12.
  const double width = layout.right - layout.left, left = layout.left + width / 22 * 1,
               right = layout.right - width / 22;
  // From -4 to 6, and a twentieth of that on each side: -3 is 1.5 of 11 up, 5 is 9.5.
  const double low = layout.bottom - 260 * 1.5 / 11, high = layout.bottom - 260 * 9.5 / 11;
  EXPECT_THAT(svg, HasSubstr('M' + number(left) + ',' + number(low) + "m"));
  EXPECT_THAT(svg, HasSubstr('M' + number(right) + ',' + number(high) + "m"));
  EXPECT_THAT(
      svg, HasSubstr('M' + number(left) + ',' + number(layout.bottom - 260 * 0.5 / 11) + 'V' + number(low)));
}

TEST_F(DrawSvg, ALineHasAGapWhereAValueIsMissing) {
  Chart chart = small_chart(ChartForm::lines);
  chart.series = {
      {.name = "a", .origin = Origin::reference, .x = {1, 2, 3, 4}, .y = {1, 2, std::nan(""), 4}}};
  const std::string svg = drawn(chart);
  const std::size_t line = svg.find("<path", svg.find("<g "));
  const std::string d = svg.substr(line, svg.find("/>", line) - line);
  EXPECT_EQ(count(d, "M"), 3U) << "the sample, and two pieces";
  EXPECT_EQ(count(d, "L"), 1U);
}

TEST_F(DrawSvg, NoTextIsAnElement) {
  const std::string hostile = "\"/><script>1</script> &lt; ]]> --> \\n '\n \xff \xEF\xBF\xBF \x1b[0m é漢";
  for (const ChartForm form : {ChartForm::lines, ChartForm::points}) {
    Chart chart = small_chart(form);
    for (std::string* text : {&chart.title, &chart.x.label, &chart.y.label, &chart.series[0].name,
                              &chart.series[0].family, &chart.series[1].name})
      *text = hostile;
    const std::string svg = drawn(chart);
    expect_well_formed(svg);
    EXPECT_THAT(svg, Not(HasSubstr("<script")));
    EXPECT_THAT(
        svg,
        HasSubstr("<title id=\"small-title\">&quot;/&gt;&lt;script&gt;1&lt;/script&gt; &amp;lt; ]]&gt;"));
  }
}

TEST_F(DrawSvg, OddValuesAreDrawnOrSaid) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const bool logarithmic : {false, true})
    for (const std::vector<double>& values : {std::vector<double>{5},
                                              {5, 5},
                                              {1e300, 1e-300},
                                              {1, std::nan(""), 3},
                                              {infinity, 1, -infinity},
                                              {1, 0, -1}}) {
      Chart chart = small_chart(ChartForm::lines);
      chart.y.logarithmic = logarithmic;
      chart.series = {{.name = "a", .x = {1, 2, 3}, .y = values}};
      chart.series[0].x.resize(values.size());
      const DrawnChart result = draw_svg(chart);
      expect_well_formed(result.svg);
      EXPECT_EQ(count(result.svg, "cannot be drawn"), result.notes.size()) << "in the description";
      for (const char* no_number : {"nan", "inf,", "-nan"})
        EXPECT_THAT(result.svg, Not(HasSubstr(no_number)));
    }
}

TEST(DrawSvgOfNothing, IsEmpty) {
  Chart chart = small_chart(ChartForm::lines);
  for (Series& series : chart.series) series.y.assign(series.y.size(), std::nan(""));
  const DrawnChart result = draw_svg(chart);
  EXPECT_EQ(result.svg, "");
  EXPECT_EQ(result.notes.size(), 3U) << "one for each series";
  chart.series.clear();
  EXPECT_EQ(draw_svg(chart).svg, "");
}

TEST(DrawSvgOfNothing, AnIdMustBeOne) {
  for (const char* id : {"", "1a", "a b", "a\"", "-a", "a_b", "ä"}) {
    Chart chart = small_chart(ChartForm::lines);
    chart.id = id;
    EXPECT_THROW(draw_svg(chart), std::invalid_argument) << id;
  }
}

}  // namespace
}  // namespace mssim
