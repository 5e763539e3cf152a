#pragma once

#include <optional>
#include <string>
#include <vector>

namespace mssim {

/// Charts as SVG for an HTML page: a Chart describes what to show, draw_svg() draws it.

/// Origin of the values of a series, which decides its look: measured ones have filled points and solid
/// lines, published ones open points and dashed lines. References, such as the roofs of a roofline, are
/// straight lines between points in the colour of the text. If shapes of points repeat, their dashes differ.
enum class Origin { measured, published, reference };

/// Mark on single points, or in place of them; larger than points and in the colour of the text.
enum class PointMark { none, ring, square, cross };

/// A line of a chart, or its points: values y over x, in the units of the axes, and their look.
struct Series {
  std::string name{};  ///< in the legend
  Origin origin = Origin::measured;
  /// What is compared, such as a configuration of the paper. Series of one family have the same colour, shape
  /// of points and pattern, and differ by their origin. If empty, or used by a series of the same origin, the
  /// series has its own look.
  std::string family{};
  std::vector<double> x{}, y{};  ///< of the same size
  /// Intervals around y, drawn as error bars: one per y, or none.
  std::vector<double> low{}, high{};
  /// For references: marks at the points instead of a line.
  PointMark mark = PointMark::none;

  /// Adds a point without an interval.
  void add(double point_x, double point_y) {
    x.push_back(point_x);
    y.push_back(point_y);
  }
};

/// An axis: its label and scale.
struct Axis {
  std::string label{};  ///< with the unit: "time per step (ms)"
  bool logarithmic = false;
  /// For a horizontal axis: its ticks are exactly the values along it, which are whole numbers.
  bool ticks_at_values = false;
};

/// Whether the points of a series are joined.
enum class ChartForm { lines, points };

/// A chart as data. A value that is not finite, or not positive on a logarithmic axis, is left out, and lines
/// have a gap there. If only an end of an interval is invalid, only the interval is left out.
/// DrawnChart::notes lists what was left out.
struct Chart {
  std::string id{};  ///< unique in the page: letters, digits and hyphens, a letter first
  std::string title{};
  std::string subtitle{};  ///< below the title, such as where it was measured
  ChartForm form = ChartForm::lines;
  Axis x{}, y{};
  std::vector<Series> series{};  ///< in the order of the legend
  /// Families that look the same in every chart that names them in the same order; others come after them.
  std::vector<std::string> families{};
  /// Remarks below the chart, sentences without full stop.
  std::vector<std::string> remarks{};
};

/// A chart as an element for an HTML page.
struct DrawnChart {
  /// An <svg> element without width and height, so that the page sets its size: 480 units wide, text of 14
  /// units. Text and axes have the colour of the page's text (currentColor), for light and dark pages. Empty
  /// if no value can be drawn.
  std::string svg;
  /// The chart's remarks, then what was left out of each series: sentences without full stop.
  std::vector<std::string> notes;
};

/// Draws a chart; the same chart gives the same bytes. All text is escaped. Throws std::invalid_argument for
/// an id or a number of values that breaks the rules above.
DrawnChart draw_svg(const Chart& chart);

/// An interval with both ends, in the unit of its axis.
struct Interval {
  double low, high;
};

/// The smallest intervals with all values that can be drawn; that of y includes the values' intervals.
struct ChartRange {
  Interval x, y;
};

/// None if no value can be drawn. Throws like draw_svg() for the number of values.
std::optional<ChartRange> range_of(const Chart& chart);

}  // namespace mssim
