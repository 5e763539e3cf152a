#include "charts/plotted_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "text/text.h"

namespace mssim {
namespace {

bool can_stand_on(const Axis& axis, double value) {
  return std::abs(value) <= largest_plotted && (!axis.logarithmic || value >= 1 / largest_plotted);
}

void require_matching_sizes(const Chart& chart, const Series& series) {
  const std::size_t values = series.y.size();
  const bool bars = chart.form == ChartForm::bars;
  const bool intervals = !series.low.empty() || !series.high.empty();
  if ((bars ? chart.groups.size() != values : series.x.size() != values) ||
      (intervals && (series.low.size() != values || series.high.size() != values)))
    throw std::invalid_argument("the series \"" + printable(series.name) +
                                "\" of a chart has not as many values everywhere");
}

void widen(Interval& range, double value) {
  range.low = std::min(range.low, value);
  range.high = std::max(range.high, value);
}

constexpr Interval no_range{std::numeric_limits<double>::infinity(),
                            -std::numeric_limits<double>::infinity()};

std::string left_out(std::size_t some, std::size_t all, const std::string& what, const Series& series) {
  return std::to_string(some) + " of " + pluralize(all, what) + " of \"" + printable(series.name) + "\"";
}

}  // namespace

bool PlottedValues::empty() const {
  return std::all_of(series.begin(), series.end(), [](const auto& points) { return points.empty(); });
}

Interval PlottedValues::x_range() const {
  Interval range = no_range;
  for (const auto& points : series)
    for (const PlottedPoint& point : points) widen(range, point.x);
  return range;
}

Interval PlottedValues::y_range() const {
  Interval range = no_range;
  for (const auto& points : series)
    for (const PlottedPoint& point : points) {
      widen(range, point.y);
      if (!point.interval) continue;
      widen(range, point.interval->low);
      widen(range, point.interval->high);
    }
  return range;
}

PlottedValues plotted_values(const Chart& chart) {
  PlottedValues values;
  for (const Series& series : chart.series) {
    require_matching_sizes(chart, series);
    std::vector<PlottedPoint>& points = values.series.emplace_back();
    std::size_t intervals_left_out = 0;
    bool gap = false;
    for (std::size_t i = 0; i < series.y.size(); ++i) {
      const double x = chart.form == ChartForm::bars ? static_cast<double>(i) : series.x[i];
      if (!can_stand_on(chart.x, x) || !can_stand_on(chart.y, series.y[i])) {
        gap = !points.empty();
        continue;
      }
      PlottedPoint& point = points.emplace_back(PlottedPoint{x, series.y[i], {}, gap});
      gap = false;
      if (series.low.empty()) continue;
      const Interval interval{series.low[i], series.high[i]};
      if (can_stand_on(chart.y, interval.low) && can_stand_on(chart.y, interval.high) &&
          interval.low <= interval.high)
        point.interval = interval;
      else
        ++intervals_left_out;
    }
    const std::string why = chart.x.logarithmic || chart.y.logarithmic
                                ? " cannot be drawn on a logarithmic axis, which has positive numbers only"
                                : " cannot be drawn: not finite numbers";
    if (series.y.empty()) values.notes.push_back("\"" + printable(series.name) + "\" has no values");
    if (const std::size_t missing = series.y.size() - points.size(); missing > 0)
      values.notes.push_back(left_out(missing, series.y.size(), "value", series) + why);
    if (intervals_left_out > 0)
      values.notes.push_back(left_out(intervals_left_out, points.size(), "interval", series) + why);
  }
  return values;
}

}  // namespace mssim
