#include "charts/series_style.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>
#include <string>
#include <tuple>

namespace mssim {
namespace {

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

TEST(SeriesStyle, ColoursAreSeenOnWhiteAndOnNearBlack) {
  EXPECT_NEAR(luminance("#ffffff"), 1, 1e-12);
  for (const std::string_view colour : series_colours) {
    EXPECT_GE(1.05 / (luminance(colour) + 0.05), 3) << colour;
    for (const std::string_view page : {"#000000", "#121212", "#0d1117", "#161b22"})
      EXPECT_GE((luminance(colour) + 0.05) / (luminance(page) + 0.05), 3) << colour << " on " << page;
  }
}

TEST(SeriesStyle, AFamilyDiffersByOriginAlone) {
  const std::vector<Series> series{{.name = "a", .origin = Origin::published, .family = "gpu"},
                                   {.name = "b", .family = "cpu"},
                                   {.name = "c", .family = "gpu"},
                                   {.name = "d", .family = "gpu"},
                                   {.name = "e"}};
  const auto styles = series_styles(series);
  EXPECT_EQ(styles[0].family, styles[2].family);
  EXPECT_NE(styles[0].origin, styles[2].origin);
  EXPECT_NE(styles[3].family, styles[2].family) << "two measured ones must not look alike";
  EXPECT_NE(styles[1].family, styles[0].family);
}

TEST(SeriesStyle, AFixedFamilyLooksTheSameInEveryChart) {
  const std::vector<std::string> fixed{"serial", "openmp", "opencl"};
  const std::vector<Series> one{{.name = "a", .family = "opencl"}, {.name = "b", .family = "mine"}};
  const std::vector<Series> other{
      {.name = "c", .family = "mine"}, {.name = "d", .family = "serial"}, {.name = "e", .family = "opencl"}};
  EXPECT_EQ(series_styles(one, fixed)[0].family, 2U);
  EXPECT_EQ(series_styles(one, fixed)[1].family, 3U);
  EXPECT_EQ(series_styles(other, fixed)[2].family, 2U);
  EXPECT_EQ(series_styles(other, fixed)[1].family, 0U);
}

TEST(SeriesStyle, NoTwoOfAHundredSeriesShareFamilyAndOrigin) {
  std::vector<Series> series;
  for (int i = 0; i < 100; ++i)
    series.push_back(
        {.name = "", .origin = Origin{i % 3}, .family = i % 7 ? "f" + std::to_string(i % 5) : ""});
  std::set<std::pair<std::size_t, Origin>> seen;
  for (const SeriesStyle& style : series_styles(series))
    EXPECT_TRUE(seen.emplace(style.family, style.origin).second);
}

TEST(SeriesStyle, SixFamiliesDifferWithoutColours) {
  std::set<std::size_t> shapes, patterns;
  for (const SeriesStyle& style : series_styles(std::vector<Series>(6))) {
    EXPECT_TRUE(shapes.insert(style.shape()).second);
    EXPECT_TRUE(patterns.insert(style.pattern()).second);
  }
}

TEST(SeriesStyle, TwelveLinesDifferWithoutColours) {
  std::set<std::pair<std::size_t, std::size_t>> looks_of_lines;
  for (const SeriesStyle& style : series_styles(std::vector<Series>(12)))
    EXPECT_TRUE(looks_of_lines.emplace(style.shape(), style.dashes()).second);
}

TEST(SeriesStyle, MarksTakeNoLookOfOthers) {
  const std::vector<Series> lines{{.name = "a"}, {.name = "roof", .origin = Origin::reference}};
  std::vector<Series> with_marks = lines;
  with_marks.insert(with_marks.begin(),
                    {.name = "front", .origin = Origin::reference, .mark = PointMark::ring});
  EXPECT_EQ(series_styles(with_marks)[1].family, series_styles(lines)[0].family);
  EXPECT_EQ(series_styles(with_marks)[2].family, series_styles(lines)[1].family);
}

TEST(SeriesStyle, AFillSaysWhatItLooksLike) {
  for (const Origin origin : {Origin::measured, Origin::published})
    for (std::size_t family = 0; family < 300; ++family) {
      const SeriesStyle style{family, origin}, same = style_of_fill(style.fill());
      EXPECT_LT(style.fill(), 100U) << "more than two digits";
      EXPECT_EQ(same.colour(), style.colour());
      EXPECT_EQ(same.pattern(), style.pattern());
      EXPECT_EQ(same.origin, style.origin);
    }
}

}  // namespace
}  // namespace mssim
