#include "charts/chart_layout.h"

#include <algorithm>

#include "charts/chart_text.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr double plot_height = 260;
constexpr double letter_width = 8.5;  // on the safe side: the fonts of pages differ
constexpr double legend_sample = 60;
constexpr double legend_row = 1.5 * font_size;  // as gnuplot has it

double drawn_width(const std::string& text) { return letter_width * static_cast<double>(width_of(text)); }

double widest(const std::vector<std::string>& texts) {
  double width = 0;
  for (const std::string& text : texts) width = std::max(width, drawn_width(text));
  return width;
}

std::size_t letters_that_fit(double width) { return static_cast<std::size_t>(width / letter_width); }

std::vector<std::string> tick_labels(const AxisScale& scale) {
  std::vector<std::string> labels;
  for (const Tick& tick : scale.ticks) labels.push_back(tick.label);
  return labels;
}

AxisScale scale_of(const Axis& axis, Interval range) {
  return axis.logarithmic ? logarithmic_scale(range.low, range.high) : linear_scale(range.low, range.high);
}

AxisScale y_scale(const Chart& chart, Interval range) {
  if (chart.form == ChartForm::bars && !chart.y.logarithmic) return scale_from_zero(range.low, range.high);
  return scale_of(chart.y, range);
}

/// Title and label of the y axis, above the plot.
void lay_out_head(ChartLayout& layout, const Chart& chart) {
  const double width = chart_width - 2 * chart_edge;
  layout.title = shown_lines(chart.title, letters_that_fit(0.95 * width));  // bold letters are wider
  layout.y_label = shown_text(chart.y.label, letters_that_fit(width));
  layout.y_label_middle = chart_edge + line_height * (static_cast<double>(layout.title.size()) + 0.5) + 4;
  layout.top = layout.y_label_middle + line_height / 2 + 12;
}

void lay_out_plot(ChartLayout& layout, const Chart& chart, const PlottedValues& values) {
  layout.y = y_scale(chart, values.y_range());
  layout.x = chart.form == ChartForm::bars
                 ? AxisScale{-0.5, static_cast<double>(chart.groups.size()) - 0.5, {}}
                 : scale_of(chart.x, values.x_range());
  layout.left = chart_edge + widest(tick_labels(layout.y)) + 12;
  // The last label of the x axis may stand half beside it.
  const double beside = layout.x.ticks.empty() ? 0 : drawn_width(layout.x.ticks.back().label) / 2;
  layout.right = chart_width - chart_edge - beside;
  layout.bottom = layout.top + plot_height;
}

/// What stands below the x axis: ticks or groups, and its label.
void lay_out_foot(ChartLayout& layout, const Chart& chart) {
  double below = 14 + line_height;
  if (chart.form == ChartForm::bars) {
    constexpr std::size_t longest_group = 16;
    for (const std::string& group : chart.groups) layout.groups.push_back(shown_text(group, longest_group));
    layout.group_labels = layout.bottom + line_height / 2 + 5;
    const double width = widest(layout.groups);
    layout.groups_tilted = width > (layout.right - layout.left) / static_cast<double>(chart.groups.size());
    if (layout.groups_tilted) below = 18 + 0.6 * width;  // the sine of their angle
  }
  layout.x_label = shown_text(chart.x.label, letters_that_fit(chart_width - 2 * chart_edge));
  layout.x_label_middle = layout.bottom + below + line_height / 2;
}

void lay_out_legend(ChartLayout& layout, const Chart& chart, const PlottedValues& values) {
  const double width = chart_width - 2 * chart_edge;
  std::vector<std::string> in_legend;
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    layout.names.push_back(shown_text(chart.series[s].name, letters_that_fit(width - legend_sample)));
    if (!values.series[s].empty()) in_legend.push_back(layout.names.back());
  }
  const double column = widest(in_legend) + legend_sample;
  layout.legend = layout.x_label_middle + line_height;
  layout.legend_columns = in_legend.size() > 2 && 2 * column < width ? 2 : 1;
  layout.legend_rows = (in_legend.size() + layout.legend_columns - 1) / layout.legend_columns;
  layout.height = layout.legend + legend_row * static_cast<double>(layout.legend_rows) + chart_edge;
}

}  // namespace

ChartLayout chart_layout(const Chart& chart, const PlottedValues& values) {
  ChartLayout layout;
  lay_out_head(layout, chart);
  lay_out_plot(layout, chart, values);
  lay_out_foot(layout, chart);
  lay_out_legend(layout, chart, values);
  return layout;
}

}  // namespace mssim
