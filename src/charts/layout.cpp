#include "charts/layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include "text/text.h"

namespace mssim {
namespace {

bool can_stand_on(const Axis& axis, double value) {
  return std::abs(value) <= largest_plotted && (!axis.logarithmic || value >= 1 / largest_plotted);
}

void require_matching_sizes(const Series& series) {
  const std::size_t values = series.y.size();
  const bool intervals = !series.low.empty() || !series.high.empty();
  if (series.x.size() != values ||
      (intervals && (series.low.size() != values || series.high.size() != values)))
    throw std::invalid_argument(
        fmt::format("the lists of the series \"{}\" of a chart differ in length", printable(series.name)));
}

std::optional<ChartRange> range_of(const PlottedValues& values) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  ChartRange range{{infinity, -infinity}, {infinity, -infinity}};
  const auto widen = [](Interval& interval, double value) {
    interval = {std::min(interval.low, value), std::max(interval.high, value)};
  };
  for (const auto& points : values.series)
    for (const PlottedPoint& point : points) {
      widen(range.x, point.x);
      widen(range.y, point.y);
      if (!point.interval) continue;
      widen(range.y, point.interval->low);
      widen(range.y, point.interval->high);
    }
  return range.x.low <= range.x.high ? std::optional(range) : std::nullopt;
}

/// Valid UTF-8 without what XML forbids.
std::string clean(std::string_view text) {
  std::string result(text);
  for (const char space : {'\n', '\r', '\t'}) std::ranges::replace(result, space, ' ');
  result = escaped(result);
  for (const std::string_view no_character : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"})
    for (std::size_t at = 0; (at = result.find(no_character, at)) != std::string::npos;)
      result.replace(at, no_character.size(), "\uFFFD");
  return result;
}

std::string cut(std::string_view text, std::size_t most) {
  if (width_of(text) <= most) return std::string(text);
  return std::string(clipped(text, most - 1)) + "…";
}

constexpr int most_ticks = 6;
constexpr double room = 0.05;  // margin, as a fraction of the span of the values

/// A digit times a power of ten: as a plain number if `is_short`, else with an exponent.
std::string tick_label(int digit, int exponent, bool is_short) {
  if (is_short && exponent < 0) return fixed_decimal(digit * std::pow(10, exponent), -exponent);
  if (is_short) return grouped(static_cast<std::uint64_t>(std::llround(digit * std::pow(10, exponent))));
  constexpr const char* superscripts[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = digit == 1 ? "10" : fmt::format("{}·10", digit);
  if (exponent < 0) text += "⁻";
  for (const char figure : std::to_string(std::abs(exponent))) text += superscripts[figure - '0'];
  return text;
}

/// Ticks at the given multiples of every `step`-th power of ten.
std::vector<Tick> decade_ticks(double low, double high, std::initializer_list<int> digits, int step) {
  const int first = static_cast<int>(std::floor(std::log10(low))),
            last = static_cast<int>(std::ceil(std::log10(high)));
  std::vector<Tick> ticks;
  for (int exponent = first; exponent <= last; ++exponent) {
    if (exponent % step != 0) continue;
    for (const int digit : digits)
      if (const double value = digit * std::pow(10.0, exponent); value >= low && value <= high)
        ticks.push_back({value, tick_label(digit, exponent, first >= -4 && last <= 6)});
  }
  return ticks;
}

constexpr double plot_height = 260;
constexpr double letter_width = 8.5;  // a wide estimate: the fonts of pages differ
constexpr double inner_width = chart_width - 2 * chart_edge;

double drawn_width(const std::string& text) { return letter_width * static_cast<double>(width_of(text)); }

double widest(const std::vector<std::string>& texts) {
  double width = 0;
  for (const std::string& text : texts) width = std::max(width, drawn_width(text));
  return width;
}

std::size_t letters_that_fit(double width) { return static_cast<std::size_t>(width / letter_width); }

AxisScale scale_of(const Axis& axis, Interval range) {
  return (axis.logarithmic ? logarithmic_scale : linear_scale)(range.low, range.high);
}

std::vector<Tick> ticks_at(const PlottedValues& values) {
  std::set<double> along;
  for (const auto& points : values.series)
    for (const PlottedPoint& point : points) along.insert(point.x);
  return mapped<Tick>(along, [](double x) {
    return Tick{x, grouped(static_cast<std::uint64_t>(std::llround(x)))};
  });
}

/// The row of each label: labels that would overlap go to a second row, and those without room there are left
/// out. The last one, which shows where the axis ends, is placed first.
std::vector<std::optional<int>> rows_of_labels(const AxisScale& scale, double width) {
  constexpr double apart = 3;
  std::vector<std::optional<int>> rows(scale.ticks.size());
  std::array<std::vector<Interval>, 2> taken;
  const auto place = [&](std::size_t i) {
    const double middle = scale.fraction(scale.ticks[i].value) * width,
                 half = (drawn_width(scale.ticks[i].label) + apart) / 2;
    for (std::size_t row = 0; row < taken.size() && !rows[i]; ++row) {
      const bool is_free = std::ranges::none_of(taken[row], [&](const Interval& other) {
        return other.low < middle + half && middle - half < other.high;
      });
      if (!is_free) continue;
      taken[row].push_back({middle - half, middle + half});
      rows[i] = static_cast<int>(row);
    }
  };
  if (!rows.empty()) place(rows.size() - 1);
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) place(i);
  return rows;
}

/// Title, subtitle and label of the y axis, above the plot.
void lay_out_head(ChartLayout& layout, const Chart& chart) {
  layout.title = shown_lines(chart.title, letters_that_fit(0.95 * inner_width));  // bold letters are wider
  layout.subtitle = shown_lines(chart.subtitle, letters_that_fit(inner_width));
  layout.y_label = shown_text(chart.y.label, letters_that_fit(inner_width));
  const auto lines = static_cast<double>(layout.title.size() + layout.subtitle.size());
  layout.y_label_middle = chart_edge + line_height * (lines + 0.5) + 4;
  layout.top = layout.y_label_middle + line_height / 2 + 12;
}

void lay_out_plot(ChartLayout& layout, const Chart& chart, const PlottedValues& values,
                  const ChartRange& range) {
  layout.y = scale_of(chart.y, range.y);
  layout.x = scale_of(chart.x, range.x);
  if (chart.x.ticks_at_values) layout.x.ticks = ticks_at(values);
  layout.left = chart_edge + widest(mapped<std::string>(layout.y.ticks, &Tick::label)) + 12;
  // Half of the last label of the x axis may extend beyond the plot.
  const double beside = layout.x.ticks.empty() ? 0 : drawn_width(layout.x.ticks.back().label) / 2;
  layout.right = chart_width - chart_edge - beside;
  layout.bottom = layout.top + plot_height;
  layout.tick_rows = rows_of_labels(layout.x, layout.right - layout.left);
}

/// The parts below the x axis: ticks and its label.
void lay_out_foot(ChartLayout& layout, const Chart& chart) {
  layout.tick_labels = layout.bottom + line_height / 2 + 5;
  const bool second_row = std::ranges::find(layout.tick_rows, 1) != layout.tick_rows.end();
  const double below = 10 + line_height * (second_row ? 2 : 1);
  layout.x_label = shown_text(chart.x.label, letters_that_fit(inner_width));
  layout.x_label_middle = layout.bottom + below + line_height / 2;
}

void lay_out_legend(ChartLayout& layout, const Chart& chart, const PlottedValues& values) {
  std::vector<std::size_t> shown;  // series
  double width = 0;                // of the widest name
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    layout.legend.push_back(
        {shown_lines(chart.series[s].name, letters_that_fit(inner_width - legend_sample))});
    if (values.series[s].empty()) continue;
    shown.push_back(s);
    width = std::max(width, widest(layout.legend[s].lines));
  }
  const bool halves = shown.size() > 2 && 2 * (width + legend_sample) < inner_width;
  const std::size_t rows = halves ? (shown.size() + 1) / 2 : shown.size();
  const double top = layout.x_label_middle + line_height;
  double y = top, bottom = top;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (i == rows) y = top;
    SeriesEntry& entry = layout.legend[shown[i]];
    entry.left = chart_edge + (i < rows ? 0 : inner_width / 2);
    entry.middle = y + legend_row / 2;
    y += legend_row;
    if (entry.lines.size() > 1) y += line_height * static_cast<double>(entry.lines.size() - 1);
    bottom = std::max(bottom, y);
  }
  layout.height = bottom + chart_edge;
}

}  // namespace

PlottedValues plotted_values(const Chart& chart) {
  PlottedValues values;
  for (const Series& series : chart.series) {
    require_matching_sizes(series);
    std::vector<PlottedPoint>& points = values.series.emplace_back();
    std::size_t intervals_left_out = 0;
    bool gap = false;
    for (std::size_t i = 0; i < series.y.size(); ++i) {
      const double x = series.x[i];
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
    const std::string name = '"' + printable(series.name) + '"';
    const auto say = [&](std::size_t some, std::size_t all, std::string_view what) {
      if (some > 0)
        values.notes.push_back(fmt::format("{} of {} of {} cannot be drawn{}", some, pluralize(all, what),
                                           name,
                                           chart.x.logarithmic || chart.y.logarithmic
                                               ? " on a logarithmic axis, which needs positive numbers"
                                               : ": not finite numbers"));
    };
    if (series.y.empty()) values.notes.push_back(name + " has no values");
    say(series.y.size() - points.size(), series.y.size(), "value");
    say(intervals_left_out, points.size(), "interval");
  }
  return values;
}

std::optional<ChartRange> range_of(const Chart& chart) { return range_of(plotted_values(chart)); }

std::vector<std::size_t> looks_of(std::span<const Series> series, std::span<const std::string> fixed) {
  std::vector<std::size_t> looks;
  std::map<std::string, std::size_t> families;
  std::size_t next = 0, next_reference = 0;
  for (const std::string& family : fixed) families.try_emplace(family, next++);
  for (const Series& one : series) {
    if (one.origin == Origin::reference) {
      looks.push_back(one.mark == PointMark::none ? next_reference++ : 0);
      continue;
    }
    auto known = families.find(one.family);
    for (std::size_t s = 0; s < looks.size() && known != families.end(); ++s)
      if (looks[s] == known->second && series[s].origin == one.origin) known = families.end();
    looks.push_back(known != families.end() ? known->second : next++);
    if (!one.family.empty()) families.try_emplace(one.family, looks.back());
  }
  return looks;
}

std::string shown_text(std::string_view text, std::size_t most) { return cut(clean(text), most); }

std::vector<std::string> shown_lines(std::string_view text, std::size_t most) {
  constexpr std::size_t most_lines = 3;
  std::vector<std::string> lines;
  std::string rest = clean(text);
  while (!rest.empty()) {
    if (lines.size() + 1 == most_lines || width_of(rest) <= most) {
      lines.push_back(cut(rest, most));
      break;
    }
    const std::size_t space = clipped(rest, most + 1).find_last_of(' ');
    const std::size_t end =
        space == std::string_view::npos || space == 0 ? clipped(rest, most).size() : space;
    lines.push_back(rest.substr(0, end));
    rest.erase(0, end);
    rest.erase(0, rest.find_first_not_of(' '));
  }
  return lines;
}

double AxisScale::fraction(double value) const {
  return logarithmic ? (std::log10(value) - std::log10(low)) / (std::log10(high) - std::log10(low))
                     : (value - low) / (high - low);
}

AxisScale linear_scale(double low, double high) {
  if (low > 0 && low < high / 2) low = 0;
  if (high < 0 && high > low / 2) high = 0;
  double beside = room * (high - low);
  // For a single value, the axis extends around it.
  if (!(beside > 1e-8 * std::max(std::abs(low), std::abs(high)))) beside = low == 0 ? 1 : std::abs(low) / 2;
  const double from = low == 0 ? 0 : low - beside, to = high == 0 && low < 0 ? 0 : high + beside;
  return {from, to, ticks_between(from, to, most_ticks)};
}

AxisScale logarithmic_scale(double low, double high) {
  const double decades = std::log10(high) - std::log10(low);
  const double factor = std::pow(10.0, std::clamp(room * decades, 0.1, 1.0));
  low /= factor;
  high *= factor;
  std::vector<Tick> ticks;
  const int step = static_cast<int>(std::ceil((decades + 1) / (most_ticks + 2)));
  for (const auto& digits : {std::initializer_list<int>{1}, {1, 3}, {1, 2, 5}})
    if (ticks.size() < 3) ticks = decade_ticks(low, high, digits, step);
  if (ticks.size() < 2) ticks = ticks_between(low, high, most_ticks);
  return {low, high, std::move(ticks), true};
}

std::optional<ChartLayout> chart_layout(const Chart& chart, const PlottedValues& values) {
  const auto range = range_of(values);
  if (!range) return std::nullopt;
  ChartLayout layout;
  lay_out_head(layout, chart);
  lay_out_plot(layout, chart, values, *range);
  lay_out_foot(layout, chart);
  lay_out_legend(layout, chart, values);
  return layout;
}

}  // namespace mssim
