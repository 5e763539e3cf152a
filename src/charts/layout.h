#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "charts/chart.h"
#include "picture/legend.h"

namespace mssim {

/// What a chart becomes before it is drawn: values, looks, texts that fit, scales and places.

/// No axis goes beyond this, nor a logarithmic one below its inverse: the room beside values must be finite.
inline constexpr double largest_plotted = 1e300;

/// A value that can be drawn.
struct PlottedPoint {
  double x, y;
  std::optional<Interval> interval;
  bool after_gap = false;  ///< values between the point before and this one were left out
};

struct PlottedValues {
  std::vector<std::vector<PlottedPoint>> series;  ///< one for each of the chart's, in its order
  std::vector<std::string> notes;                 ///< what was left out, a sentence for each such series
};

/// Leaves out what Chart says. Throws std::invalid_argument where the numbers of values disagree.
PlottedValues plotted_values(const Chart& chart);

/// Colours of series, each with a contrast of at least 3 to 1 on white and on near-black (WCAG 2.2, 1.4.11),
/// so that a chart needs none of its own for dark pages.
inline constexpr std::array<std::string_view, 12> series_colours{"#2f7ed8", "#b8720a", "#2e8f57", "#d9534f",
                                                                 "#9b59b6", "#12858c", "#c2508a", "#8a7a00",
                                                                 "#808080", "#6d67e4", "#96603c", "#4f8f00"};

/// The number of each series's look: from it follow colour, shape, dash and pattern. No two series of one
/// origin have the same but those of marks. The families `fixed` have the first numbers, whether they occur
/// or not. References that are lines have a numbering of their own.
std::vector<std::size_t> looks_of(std::span<const Series> series, std::span<const std::string> fixed = {});

/// Any text as a chart shows it: on one line, of characters that XML may have, at most `most` letters wide;
/// the last is … where it was wider.
std::string shown_text(std::string_view text, std::size_t most);

/// The same in at most three lines, broken at spaces where there are some.
std::vector<std::string> shown_lines(std::string_view text, std::size_t most);

/// The part of an axis that a chart shows.
struct AxisScale {
  double low, high;  ///< low < high
  std::vector<Tick> ticks;
  bool logarithmic = false;

  /// Where a value stands: 0 at `low`, 1 at `high`.
  double fraction(double value) const;
};

/// A scale with a little room beside the finite values from `low` to `high`, which begins at zero if it would
/// begin near it.
AxisScale linear_scale(double low, double high);

/// A logarithmic one of positive values: ticks at powers of ten, in between too where there are few.
AxisScale logarithmic_scale(double low, double high);

/// The width of a chart in units of which text has font_size; its height follows from what is on it.
inline constexpr double chart_width = 480;
inline constexpr double font_size = 14;
inline constexpr double line_height = 19;
inline constexpr double legend_row = 21;
inline constexpr double legend_sample = 60;  ///< what stands before a name in the legend
inline constexpr double chart_edge = 8;      ///< around everything

/// Where the parts of a chart are, in units from its left upper corner, one below the other: title, label of
/// the y axis (which lies so that nobody tilts the head), the plot, ticks and label of the x axis, legend.
struct ChartLayout {
  AxisScale x, y;
  std::vector<std::string> title, subtitle;  ///< lines
  std::string x_label, y_label;
  std::vector<std::string> names;  ///< of the series in the legend
  std::size_t legend_columns = 1, legend_rows = 1;
  double left = 0, right = 0, top = 0, bottom = 0;  ///< of the plot
  double y_label_middle = 0, x_label_middle = 0;    ///< from above
  double tick_labels = 0;                           ///< along x: the middle of their labels in the first row
  /// Of each tick along x: the row that its label stands in, which is free there; none for one without room.
  std::vector<std::optional<int>> tick_rows;
  double legend = 0, height = 0;  ///< top of the legend; the whole
};

/// None where there is no value.
std::optional<ChartLayout> chart_layout(const Chart& chart, const PlottedValues& values);

}  // namespace mssim
