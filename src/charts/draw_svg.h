#pragma once

#include <string>
#include <vector>

#include "charts/chart.h"

namespace mssim {

/// A chart for an HTML page, or why there is none.
struct DrawnChart {
  /// An <svg> element without width and height, so that the page says how wide it is: 480 units, in which
  /// text has 14. Text and axes have the colour of the page's text (currentColor), so that it suits light and
  /// dark pages. Empty where there is none.
  std::string svg;
  std::string problem;  ///< why there is none, a sentence without full stop; else empty
  /// The chart's remarks, then what was left out of each series: sentences without full stop.
  std::vector<std::string> notes;
};

/// Draws it with gnuplot, which must be in PATH. The same chart gives the same bytes with the same gnuplot.
/// No text of the chart is taken for a command or an element, whatever it holds. Throws std::invalid_argument
/// for an id or a number of values that breaks the rules of chart.h, and Interrupted.
DrawnChart draw_svg(const Chart& chart);

}  // namespace mssim
