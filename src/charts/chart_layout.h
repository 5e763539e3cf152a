#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "charts/axis_scale.h"
#include "charts/chart.h"
#include "charts/plotted_values.h"

namespace mssim {

/// The width of a chart in units of which text has font_size; its height follows from what is on it.
inline constexpr double chart_width = 480;
inline constexpr int font_size = 14;
inline constexpr double line_height = 19;
inline constexpr double chart_edge = 8;  ///< around everything

/// Where the parts of a chart are, in units from its left upper corner, one below the other: title, label of
/// the y axis (which lies so that nobody tilts the head), the plot, ticks and label of the x axis, legend.
struct ChartLayout {
  AxisScale x, y;
  std::vector<std::string>
      title;  ///< its lines, of which the first has its middle half a line below the edge
  std::string x_label, y_label;
  std::vector<std::string> groups;  ///< labels of bars
  bool groups_tilted = false;       ///< because they are too long to stand side by side
  std::vector<std::string> names;   ///< of the series in the legend
  std::size_t legend_columns = 1, legend_rows = 1;
  double left = 0, right = 0, top = 0, bottom = 0;  ///< of the plot
  double y_label_middle = 0, x_label_middle = 0;    ///< from above
  double group_labels = 0;        ///< of bars: the middle, or where tilted the end, of their labels
  double legend = 0, height = 0;  ///< top of the legend; the whole
};

/// `values` must not be empty.
ChartLayout chart_layout(const Chart& chart, const PlottedValues& values);

}  // namespace mssim
