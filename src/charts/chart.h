#pragma once

#include <optional>
#include <string>
#include <vector>

namespace mssim {

/// Charts as SVG for an HTML page: a Chart says what is to be shown, draw_svg() draws it.

/// Where the values of a series come from, which its look says: measured ones have filled points and solid
/// lines, published ones open points and dashed lines. References are straight lines from point to point in
/// the colour of the text, such as the roofs of a roofline. Where shapes of points repeat, lines have other
/// dashes.
enum class Origin { measured, published, reference };

/// A sign on single points of other series, or in place of one: larger than points, in the colour of the
/// text.
enum class PointMark { none, ring, square, cross };

struct Series {
  std::string name{};  ///< as the legend has it
  Origin origin = Origin::measured;
  /// What is to be compared, such as a configuration of the paper: series of one family share colour, point
  /// and pattern, and differ by their origin. Empty, or taken by a series of the same origin: one of its own.
  std::string family{};
  std::vector<double> x{}, y{};  ///< as many of both
  /// Intervals around y, drawn as error bars: as many as y, or none.
  std::vector<double> low{}, high{};
  /// Signs at the points instead of a line, for references.
  PointMark mark = PointMark::none;

  /// A point without an interval.
  void add(double point_x, double point_y) {
    x.push_back(point_x);
    y.push_back(point_y);
  }
};

struct Axis {
  std::string label;  ///< with the unit: "time per step (ms)"
  bool logarithmic = false;
  /// Of a horizontal axis: its ticks are the values along it, which are whole numbers, and no others.
  bool ticks_at_values = false;
};

enum class ChartForm { lines, points };

/// What is drawn, as data. A value that is not finite, or not positive on a logarithmic axis, is left out,
/// and lines have a gap there; an interval with such an end is left out alone. What was left out is said.
struct Chart {
  std::string id;  ///< unique in the page: letters, digits and hyphens, a letter first
  std::string title;
  std::string subtitle{};  ///< below the title, such as where it was measured
  ChartForm form = ChartForm::lines;
  Axis x, y;
  std::vector<Series> series;  ///< in the order of the legend
  /// Families that look the same in every chart that names them in the same order; others come after them.
  std::vector<std::string> families{};
  /// What is to be said below it, each a sentence without full stop.
  std::vector<std::string> remarks{};
};

struct DrawnChart {
  /// An <svg> element without width and height, so that the page says how wide it is: 480 units, in which
  /// text has 14. Text and axes have the colour of the page's text (currentColor), so that it suits light and
  /// dark pages. Empty where no value can be drawn.
  std::string svg;
  /// The chart's remarks, then what was left out of each series: sentences without full stop.
  std::vector<std::string> notes;
};

/// The same chart gives the same bytes. No text of the chart is taken for an element, whatever it holds.
/// Throws std::invalid_argument for an id or a number of values that breaks the rules above.
DrawnChart draw_svg(const Chart& chart);

struct Interval {
  double low, high;
};

/// The smallest intervals that hold all values that can be drawn, those along y with their intervals.
struct ChartRange {
  Interval x, y;
};

/// None where no value can be drawn. Throws as draw_svg() does for the number of values.
std::optional<ChartRange> range_of(const Chart& chart);

}  // namespace mssim
