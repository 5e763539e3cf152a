#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mssim {

/// What a page says of a chart beside the drawing, each a text of shown_text().
struct ChartWords {
  std::string id;
  std::string title;        ///< its name for who cannot see it
  std::string description;  ///< what is on it, for the same
};

/// The SVG that gnuplot wrote for a script of gnuplot_script(), as an element of an HTML page: ids are unique
/// in the page, black is the colour of the page's text, fills of bars are patterns, and what shows nothing is
/// left out. None where it is not complete or has an element that gnuplot does not write.
std::optional<std::string> page_svg(std::string_view drawing, const ChartWords& words);

}  // namespace mssim
