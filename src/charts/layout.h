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

/// Layout of a chart before it is drawn: values, looks, texts that fit, scales and positions.

/// Limit of axes; logarithmic ones also end at its inverse. It keeps margins around values finite.
inline constexpr double largest_plotted = 1e300;

/// A value that can be drawn.
struct PlottedPoint {
  double x, y;
  std::optional<Interval> interval;
  bool after_gap = false;  ///< values between the point before and this one were left out
};

/// The values of a chart that can be drawn.
struct PlottedValues {
  std::vector<std::vector<PlottedPoint>> series;  ///< one for each series of the chart, in its order
  std::vector<std::string> notes;                 ///< what was left out, one sentence per series
};

/// Leaves out values as described at Chart. Throws std::invalid_argument if the numbers of values differ.
PlottedValues plotted_values(const Chart& chart);

/// Colours of series, each with a contrast of at least 3 to 1 on white and on near-black (WCAG 2.2, 1.4.11),
/// so that light and dark pages have the same colours.
inline constexpr std::array<std::string_view, 14> series_colours{
    "#2f7ed8", "#b8720a", "#2e8f57", "#d9534f", "#9b59b6", "#12858c", "#c2508a",
    "#8a7a00", "#808080", "#6d67e4", "#96603c", "#4f8f00", "#909860", "#a888b8"};

/// The number of each series' look, which decides colour, shape, dash and pattern. Series of one origin have
/// different looks, except for marks. The families `fixed` have the first numbers, whether or not they occur.
/// Reference lines are numbered separately.
std::vector<std::size_t> looks_of(std::span<const Series> series, std::span<const std::string> fixed = {});

/// Any text as a chart shows it: on one line, of characters allowed in XML, at most `most` letters wide; a
/// longer text ends in "…".
std::string shown_text(std::string_view text, std::size_t most);

/// Text like that of shown_text, on at most three lines of `most` letters, broken at spaces if possible.
std::vector<std::string> shown_lines(std::string_view text, std::size_t most);

/// The part of an axis that a chart shows.
struct AxisScale {
  double low, high;  ///< low < high
  std::vector<Tick> ticks;
  bool logarithmic = false;

  /// Position of a value: 0 at `low`, 1 at `high`.
  double fraction(double value) const;
};

/// A scale with a small margin around the finite values from `low` to `high`. It begins at zero if it would
/// begin near it.
AxisScale linear_scale(double low, double high);

/// A logarithmic scale of positive values: ticks at powers of ten, and between them if there are few.
AxisScale logarithmic_scale(double low, double high);

/// The width of a chart in units of which text has font_size; its height depends on its content.
inline constexpr double chart_width = 480;
inline constexpr double font_size = 14;
inline constexpr double line_height = 19;
inline constexpr double legend_row = 21;
inline constexpr double legend_sample = 60;  ///< the sample before a name in the legend
inline constexpr double chart_edge = 8;      ///< margin of the chart

/// A series in the legend.
struct SeriesEntry {
  std::vector<std::string> lines;  ///< its name
  double left = 0, middle = 0;     ///< of its sample and its first line
};

/// Positions of the parts of a chart, in units from its upper left corner, from top to bottom: title, label
/// of the y axis (horizontal), plot, ticks and label of the x axis, legend.
struct ChartLayout {
  AxisScale x, y;
  std::vector<std::string> title, subtitle;  ///< lines
  std::string x_label, y_label;
  double left = 0, right = 0, top = 0, bottom = 0;  ///< of the plot
  double y_label_middle = 0, x_label_middle = 0;    ///< from the top
  double tick_labels = 0;                           ///< along x: the middle of their labels in the first row
  /// For each tick along x, the row of its label; none if there is no room for it.
  std::vector<std::optional<int>> tick_rows;
  std::vector<SeriesEntry> legend;  ///< of each series; the columns are filled one after the other
  double height = 0;
};

/// None if there is no value.
std::optional<ChartLayout> chart_layout(const Chart& chart, const PlottedValues& values);

}  // namespace mssim
