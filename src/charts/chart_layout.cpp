#include "charts/chart_layout.h"

#include <algorithm>

#include "charts/chart_text.h"

namespace mssim {
namespace {

constexpr double plot_height = 260;
constexpr double edge = 8;               // around everything
constexpr double character_width = 8.5;  // on the safe side: the fonts of pages differ
constexpr double legend_sample = 60;
constexpr double legend_row = 1.5 * font_size;  // as gnuplot has it

double width_of(const std::string& text) {
  return character_width * static_cast<double>(characters_in(text));
}

double widest(const std::vector<std::string>& texts) {
  double width = 0;
  for (const std::string& text : texts) width = std::max(width, width_of(text));
  return width;
}

std::vector<std::string> tick_labels(const AxisScale& scale) {
  std::vector<std::string> labels;
  for (const Tick& tick : scale.ticks) labels.push_back(tick.label);
  return labels;
}

std::size_t characters_that_fit(double width) { return static_cast<std::size_t>(width / character_width); }

AxisScale scale_of(const Axis& axis, Interval range) {
  return axis.logarithmic ? logarithmic_scale(range.low, range.high) : linear_scale(range.low, range.high);
}

AxisScale y_scale(const Chart& chart, Interval range) {
  if (chart.form == ChartForm::bars && !chart.y.logarithmic) return scale_from_zero(range.low, range.high);
  return scale_of(chart.y, range);
}

}  // namespace

ChartLayout chart_layout(const Chart& chart, const PlottedValues& values) {
  const bool bars = chart.form == ChartForm::bars;
  ChartLayout layout;
  layout.title = shown_lines(chart.title, characters_that_fit(0.95 * (chart_width - 2 * edge)));
  layout.y = y_scale(chart, values.y_range());
  layout.x = bars ? AxisScale{-0.5, static_cast<double>(chart.groups.size()) - 0.5, {}}
                  : scale_of(chart.x, values.x_range());

  layout.left = edge + widest(tick_labels(layout.y)) + 12;
  layout.right =
      chart_width - edge - (layout.x.ticks.empty() ? 0 : width_of(layout.x.ticks.back().label) / 2);
  layout.top = edge + line_height * static_cast<double>(layout.title.size() + 1) + 16;
  layout.bottom = layout.top + plot_height;

  double below = 14 + line_height;
  if (bars) {
    const double place = (layout.right - layout.left) / static_cast<double>(chart.groups.size());
    for (const std::string& group : chart.groups) layout.groups.push_back(shown_text(group, 16));
    const double width = widest(layout.groups);
    layout.groups_tilted = width > place;
    if (layout.groups_tilted) below = 18 + 0.6 * width;
  }
  layout.x_label = layout.bottom + below + line_height / 2;
  layout.legend = layout.x_label + line_height;

  std::vector<std::string> in_legend;
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    layout.names.push_back(
        shown_text(chart.series[s].name, characters_that_fit(chart_width - 2 * edge - legend_sample)));
    if (!values.series[s].empty()) in_legend.push_back(layout.names.back());
  }
  const double column = widest(in_legend) + legend_sample;
  layout.legend_columns = in_legend.size() > 2 && 2 * column < chart_width - 2 * edge ? 2 : 1;
  layout.legend_rows = (in_legend.size() + layout.legend_columns - 1) / layout.legend_columns;
  layout.height = layout.legend + legend_row * static_cast<double>(layout.legend_rows) + edge;
  return layout;
}

}  // namespace mssim
