#include "charts/page_svg.h"

#include <gmock/gmock.h>

namespace mssim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const ChartWords words{"c1", "a < b", "what \"it\" shows"};

std::string page_of(const std::string& inside) {
  return page_svg(
             "<?xml version=\"1.0\"?>\n<svg \n viewBox=\"0 0 480 300\"\n "
             "xmlns:xlink=\"x\"\n>\n<title>chart</title>\n"
             "<desc>Produced by GNUPLOT</desc>" +
                 inside + "</svg>\n",
             words)
      .value_or("none");
}

TEST(PageSvg, IsAnElementWithANameAndWithoutASize) {
  const std::string page = page_of("");
  EXPECT_THAT(page, AllOf(testing::StartsWith("<svg id=\"c1\" class=\"chart\" viewBox=\"0 0 480 300\""),
                          HasSubstr("role=\"img\""), HasSubstr("aria-labelledby=\"c1-title\""),
                          HasSubstr("<title id=\"c1-title\">a &lt; b</title>"),
                          HasSubstr("<desc id=\"c1-description\">what &quot;it&quot; shows</desc>")));
  EXPECT_THAT(page, AllOf(Not(HasSubstr("GNUPLOT")), Not(HasSubstr("width=")), Not(HasSubstr("?xml"))));
}

TEST(PageSvg, BlackIsTheColourOfThePageInTagsAlone) {
  EXPECT_THAT(page_of("<g color=\"black\"><path stroke='black'  d='M1,2\n\t\tL3,4  '/></g>"),
              HasSubstr("<g><path stroke=\"currentColor\" d=\"M1,2 L3,4\"/></g>"));
  EXPECT_THAT(page_of("<path stroke='rgb(190, 190, 190)' class=\"gridline\" d='M0,0'/>"),
              HasSubstr("<path d=\"M0,0\" stroke=\"currentColor\" stroke-opacity=\"0.2\"/>"));
  EXPECT_THAT(page_of("<path stroke='rgb(  0,   0,   0)'/>"), HasSubstr("<path stroke=\"currentColor\"/>"));
  EXPECT_THAT(page_of("<text fill=\"black\">stroke='black' id=\"gpPt1\" ]]></text>"),
              HasSubstr("<text fill=\"currentColor\">stroke='black' id=\"gpPt1\" ]]&gt;</text>"));
}

TEST(PageSvg, IdsAreThePagesOwn) {
  const std::string page = page_of(
      "<defs><circle id='gpPt5'/><path id='gpPt7'/></defs><g id=\"chart_plot_1\"><use "
      "xlink:href='#gpPt5'/></g>");
  EXPECT_THAT(page, HasSubstr("<defs><circle id=\"c1-gpPt5\"/></defs>"));
  EXPECT_THAT(page, HasSubstr("<g><use href=\"#c1-gpPt5\"/></g>"));
}

TEST(PageSvg, FillsOfBarsArePatterns) {
  const std::string page =
      page_of("<polygon fill = 'rgb(  1,   2,   2)'/><polygon fill = 'rgb(  1,   2,   3)'/>");
  EXPECT_THAT(page, HasSubstr("<polygon fill=\"url(#c1-fill-2)\"/><polygon fill=\"url(#c1-fill-3)\"/>"));
  EXPECT_THAT(page, HasSubstr("<pattern id=\"c1-fill-2\""));
  EXPECT_THAT(page, HasSubstr("<pattern id=\"c1-fill-3\""));
}

TEST(PageSvg, WhatShowsNothingIsLeftOut) {
  const std::string empty = page_of("");
  EXPECT_EQ(
      page_of("<g fill='none'>\n\t<g>\n</g>\n</g>\n<rect fill=\"none\"/><filter id='a'><feFlood/></filter>"),
      empty);
  EXPECT_EQ(page_of("<defs><circle id='gpDot'/></defs><use xlink:href='#gpPt6' color='white'/><use "
                    "xlink:href='#gpDot'/>"),
            empty);
}

TEST(PageSvg, IsNoneWhereADrawingIsNotCompleteOrNotGnuplots) {
  EXPECT_NE(page_of("<g></g>"), "none");
  for (const char* inside :
       {"<script>1</script>", "<g>", "</g>", "<g></path>", "<path d=1/>", "<path d='1/>", "<title>",
        "<image href='http://example.org/a.png'/>", "<svg viewBox='0 0 1 1'>", "< >"})
    EXPECT_EQ(page_of(inside), "none") << inside;
  for (const char* drawing : {"", "<svg", "<svg>", "<svg viewBox='0 0 1 1'>", "<svg></svg>", "nonsense"})
    EXPECT_EQ(page_svg(drawing, words), std::nullopt) << drawing;
}

}  // namespace
}  // namespace mssim
