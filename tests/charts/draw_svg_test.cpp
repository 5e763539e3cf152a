#include "charts/draw_svg.h"

#include <gmock/gmock.h>
#include <stdlib.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "charts/chart_text.h"
#include "platform/files.h"
#include "platform/process.h"
#include "tests/support/temporary_folder.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Chart small_chart(ChartForm form) {
  Chart chart;
  chart.id = "small";
  chart.title = "Time of a step";
  chart.form = form;
  chart.x = {"nodes", form != ChartForm::bars};
  chart.y = {"time of a step (ms)", form != ChartForm::bars};
  std::vector<double> nodes{2500, 10000};
  if (form == ChartForm::bars) {
    nodes.clear();
    chart.groups = {"cloth2500", "cloth10k"};
  }
  chart.series = {{.name = "serial",
                   .origin = Origin::measured,
                   .family = "cpu",
                   .x = nodes,
                   .y = {0.1, 0.3},
                   .low = {0.09, 0.2},
                   .high = {0.2, 0.4}},
                  {.name = "CPU, published",
                   .origin = Origin::published,
                   .family = "cpu",
                   .x = nodes,
                   .y = {19.5, 80.5}}};
  if (form != ChartForm::bars)
    chart.series.push_back({.name = "bandwidth", .origin = Origin::reference, .x = nodes, .y = {0.01, 0.04}});
  return chart;
}

/// Whatever a scene may be called: commands of gnuplot and of its shell, markup of both programs, no text at
/// all.
std::string hostile(const fs::path& made_by_command) {
  const std::string file = made_by_command.string();
  return "\"; system \"touch " + file + "\"; '; system('touch " + file + "') #\n`touch " + file +
         "` @macro {/Bold x} _a ^b %g \\n é漢 &lt; <script>1</script> ]]> --> \xff \xEF\xBF\xBF \x1b[0m";
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t times = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at) ++times;
  return times;
}

/// Tests that need gnuplot.
class DrawSvg : public TemporaryFolderTest {
 protected:
  void SetUp() override {
    if (!find_program("gnuplot")) GTEST_SKIP() << "gnuplot is not installed: Debian's package gnuplot-nox";
  }

  std::string drawn(const Chart& chart) const {
    const DrawnChart result = draw_svg(chart);
    EXPECT_EQ(result.problem, "");
    return result.svg;
  }

  void expect_well_formed(const std::string& svg) const {
    const auto xmllint = find_program("xmllint");
    if (!xmllint) GTEST_SKIP() << "xmllint is not installed: Debian's package libxml2-utils";
    const ChildResult ended = run({*xmllint, {"--noout", put("chart.svg", svg).string()}, {}, folder(), 10});
    EXPECT_EQ(ended.exit_code, 0) << ended.output;
  }
};

TEST_F(DrawSvg, EachFormIsWellFormedAndHasItsTexts) {
  for (const ChartForm form : {ChartForm::lines, ChartForm::points, ChartForm::bars}) {
    const std::string svg = drawn(small_chart(form));
    expect_well_formed(svg);
    for (const char* text :
         {">Time of a step<", ">nodes<", ">time of a step (ms)<", ">serial<", ">CPU, published<"})
      EXPECT_THAT(svg, HasSubstr(text));
    EXPECT_EQ(svg.find("polygon") != std::string::npos, form == ChartForm::bars);
    EXPECT_EQ(svg.find("stroke-dasharray") != std::string::npos, form == ChartForm::lines)
        << "of the published";
  }
}

TEST_F(DrawSvg, HasNoColourOfLightPagesAndNoSize) {
  for (const ChartForm form : {ChartForm::lines, ChartForm::bars}) {
    const std::string svg = drawn(small_chart(form));
    EXPECT_THAT(svg, AllOf(HasSubstr("currentColor"), HasSubstr("viewBox=\"0 0 480 ")));
    for (const char* colour : {"black", "white", "gray", "rgb( 0, 0, 0)", "rgb(190,", "rgb( 1, 2,"})
      EXPECT_THAT(svg, Not(HasSubstr(std::string("\"") + colour))) << colour;
    EXPECT_THAT(svg.substr(0, svg.find('>')), AllOf(Not(HasSubstr(" width=")), Not(HasSubstr(" height="))));
  }
}

TEST_F(DrawSvg, ChartsOfOnePageShareNoId) {
  Chart other = small_chart(ChartForm::bars);
  other.id = "other";
  const std::string page =
      drawn(small_chart(ChartForm::bars)) + drawn(small_chart(ChartForm::lines)) + drawn(other);
  std::multiset<std::string> ids;
  const std::string before = " id=\"";
  for (std::size_t at = 0; (at = page.find(before, at)) != std::string::npos;) {
    at += before.size();
    ids.insert(page.substr(at, page.find('"', at) - at));
  }
  EXPECT_GT(ids.size(), 10U);
  for (const std::string& id : ids) {
    EXPECT_TRUE(id.starts_with("small") || id.starts_with("other")) << id;
    if (id.starts_with("small")) continue;  // there are two of these
    EXPECT_EQ(ids.count(id), 1U) << id;
  }
  // What is referred to is there.
  for (const std::string reference : {"href=\"#", "url(#"})
    for (std::size_t at = 0; (at = page.find(reference, at)) != std::string::npos;) {
      at += reference.size();
      EXPECT_NE(ids.count(page.substr(at, page.find_first_of("\")", at) - at)), 0U);
    }
}

TEST_F(DrawSvg, MarksAreSignsInTheColourOfTheText) {
  Chart chart = small_chart(ChartForm::lines);
  chart.remarks = {"What <crosses> are"};
  const std::string before = drawn(chart);
  std::set<std::string> drawings;
  for (const PointMark mark : {PointMark::ring, PointMark::square, PointMark::cross}) {
    chart.series.back() = {
        .name = "a mark", .origin = Origin::reference, .x = {2500}, .y = {0.1}, .mark = mark};
    const std::string svg = drawn(chart);
    expect_well_formed(svg);
    EXPECT_THAT(svg, AllOf(HasSubstr(">a mark<"), HasSubstr("What &lt;crosses&gt; are.")));
    EXPECT_EQ(count(svg, "color=\"currentColor\"/>"), 2U) << "in the legend and on the point";
    EXPECT_TRUE(drawings.insert(svg).second);
  }
  EXPECT_EQ(count(before, "color=\"currentColor\"/>"), 0U);
}

TEST_F(DrawSvg, LinesBeyondTheShapesOfPointsAreDashed) {
  Chart chart = small_chart(ChartForm::lines);
  chart.series.clear();
  for (int i = 0; i < 7; ++i) chart.series.push_back({.name = "a", .x = {1, 2}, .y = {1.0 + i, 2}});
  EXPECT_EQ(count(drawn(chart), "stroke-dasharray"), 1U) << "the line and its sample are one path";
  chart.series.pop_back();
  EXPECT_EQ(count(drawn(chart), "stroke-dasharray"), 0U);
}

TEST_F(DrawSvg, IsTheSameEachTime) {
  const Chart chart = small_chart(ChartForm::lines);
  EXPECT_EQ(drawn(chart), drawn(chart));
}

TEST_F(DrawSvg, NoTextIsACommandOrAnElement) {
  const fs::path made = folder() / "made-by-a-command";
  for (const ChartForm form : {ChartForm::lines, ChartForm::points, ChartForm::bars}) {
    Chart chart = small_chart(form);
    for (std::string* text : {&chart.title, &chart.x.label, &chart.y.label, &chart.series[0].name,
                              &chart.series[0].family, &chart.series[1].name})
      *text = hostile(made);
    for (std::string& group : chart.groups) group = "%g%s`'\"\n@{_^\\<&";
    const std::string svg = drawn(chart);
    expect_well_formed(svg);
    EXPECT_FALSE(fs::exists(made));
    EXPECT_THAT(svg, Not(HasSubstr("<script")));
    EXPECT_THAT(svg, HasSubstr("<title id=\"small-title\">" + xml_text(shown_text(chart.title, 4000))));
    EXPECT_EQ(count(svg, ">%g%s`'\" @{_^\\&lt;&amp;</text>"), chart.groups.size());
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
      EXPECT_EQ(result.problem, "");
      expect_well_formed(result.svg);
      for (const std::string& note : result.notes) EXPECT_THAT(result.svg, HasSubstr(xml_text(note)));
      for (const char* no_number : {"nan", "inf,", "-nan"})
        EXPECT_THAT(result.svg, Not(HasSubstr(no_number)));
    }
}

TEST_F(DrawSvg, TheUsersOwnSettingsChangeNothing) {
  const Chart chart = small_chart(ChartForm::lines);
  const std::string expected = drawn(chart);
  put(".gnuplot", "set terminal dumb\nset title 'mine'\nexit status 3\n");
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  ::setenv("HOME", folder().c_str(), 1);
  EXPECT_EQ(drawn(chart), expected);
  home.empty() ? ::unsetenv("HOME") : ::setenv("HOME", home.c_str(), 1);
}

/// Tests with another gnuplot in PATH, or none.
class DrawSvgWith : public TemporaryFolderTest {
 protected:
  DrawSvgWith() { ::setenv("PATH", folder().c_str(), 1); }
  ~DrawSvgWith() override { ::setenv("PATH", path_.c_str(), 1); }

  /// What comes of a gnuplot that does this.
  DrawnChart drawn_by(const std::string& commands) const {
    fs::permissions(put("gnuplot", "#!/bin/sh\n" + commands + "\n"), fs::perms::owner_all);
    return draw_svg(small_chart(ChartForm::lines));
  }

 private:
  const std::string path_ = std::getenv("PATH") ? std::getenv("PATH") : "";
};

TEST_F(DrawSvgWith, NoGnuplotTheRemedyIsNamed) {
  const DrawnChart result = draw_svg(small_chart(ChartForm::lines));
  EXPECT_EQ(result.problem,
            "the program gnuplot, which draws charts, is not in PATH; install Debian's package gnuplot-nox");
  EXPECT_EQ(result.svg, "");
}

TEST_F(DrawSvgWith, OneThatFailsItsLastWordsAreNamed) {
  EXPECT_THAT(drawn_by("echo 'plot x'; echo 'line 3: no such thing' >&2; exit 3").problem,
              HasSubstr("gnuplot ended with exit code 3 and wrote \"line 3: no such thing\""));
  EXPECT_THAT(drawn_by("kill -SEGV $$").problem, HasSubstr("ended with signal 11"));
  EXPECT_THAT(drawn_by("kill -XCPU $$").problem, HasSubstr("stopped after 20 s of processor time"));
}

TEST_F(DrawSvgWith, OneThatDrawsNothingThereIsNoChart) {
  for (const char* commands :
       {"exit 0", "echo nonsense >chart.svg", "echo '<svg viewBox=\"0 0 1 1\"><g>' >chart.svg"}) {
    const DrawnChart result = drawn_by(commands);
    EXPECT_THAT(result.problem, testing::EndsWith("gnuplot ended without a complete chart")) << commands;
    EXPECT_EQ(result.svg, "");
  }
}

TEST(DrawSvgOfNothing, SaysThatThereIsNothing) {
  Chart chart = small_chart(ChartForm::lines);
  for (Series& series : chart.series) series.y.assign(series.y.size(), std::nan(""));
  const DrawnChart result = draw_svg(chart);
  EXPECT_EQ(result.problem, "there is no value to draw");
  EXPECT_EQ(result.notes.size(), 3U) << "one for each series";
  chart.series.clear();
  EXPECT_EQ(draw_svg(chart).problem, "there is no value to draw");
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
