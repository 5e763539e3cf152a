#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "charts/layout.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Shapes of points, starting at the point: circle, square, triangles and diamond, pentagon, plus, star.
constexpr std::array<std::string_view, 8> point_shapes{
    "m-4.7,0a4.7,4.7 0 1,0 9.4,0a4.7,4.7 0 1,0 -9.4,0z",
    "m-4.4,-4.4h8.8v8.8h-8.8z",
    "m0,-6.3l6.3,9.5h-12.6z",
    "m0,-6.3l6.3,6.3l-6.3,6.3l-6.3,-6.3z",
    "m0,6.3l6.3,-9.5h-12.6z",
    "m0,-5.3l5,3.7l-1.9,5.9h-6.2l-1.9,-5.9z",
    "m-1.9,-5.7h3.8v3.8h3.8v3.8h-3.8v3.8h-3.8v-3.8h-3.8v-3.8h3.8z",
    "m0,-7l2.1,4.9l4.9,2.1l-4.9,2.1l-2.1,4.9l-2.1,-4.9l-4.9,-2.1l4.9,-2.1z"};

/// Shapes of PointMark.
constexpr std::array<std::string_view, 4> mark_shapes{
    "", "m-9.4,0a9.4,9.4 0 1,0 18.8,0a9.4,9.4 0 1,0 -18.8,0z", "m-9.4,-9.4h18.8v18.8h-18.8z",
    "m-5.8,-5.8l11.6,11.6m0,-11.6l-11.6,11.6"};

/// Dashes; later ones are for repeated shapes of points, so that sixteen lines differ without colours.
constexpr std::array<std::string_view, 2> measured_dashes{"", "9,4"}, published_dashes{"4,3", "4,3,1,3"};
constexpr std::array<std::string_view, 4> reference_dashes{"", "2,3", "10,3,2,3", "14,4"};

/// A coordinate, to a hundredth of a unit.
std::string number(double value) { return decimal(std::round(100 * value) / 100 + 0.0); }

/// " NAME="VALUE"", or nothing for an empty value.
std::string attribute(std::string_view name, std::string_view value) {
  return value.empty() ? "" : fmt::format(" {}=\"{}\"", name, value);
}

std::string path(const std::string& d, const std::string& attributes) {
  return d.empty() ? "" : fmt::format("<path d=\"{}\"{}/>\n", d, attributes);
}

class Drawing {
 public:
  Drawing(const Chart& chart, const PlottedValues& values, const ChartLayout& layout)
      : chart_(chart), values_(values), layout_(layout), looks_(looks_of(chart.series, chart.families)) {}

  std::string made(const std::vector<std::string>& notes) {
    head(notes);
    grid_and_axes();
    texts();
    for (std::size_t s = 0; s < chart_.series.size(); ++s)
      if (!values_.series[s].empty()) series(s);
    return std::move(svg_) + "</svg>";
  }

 private:
  /// The start tag, with a title and a description for screen readers.
  void head(const std::vector<std::string>& notes) {
    constexpr std::size_t most = 4000;
    std::string description = chart_.subtitle.empty() ? "" : chart_.subtitle + ". ";
    description += fmt::format("Along: {}. Upwards: {}. Series: {}.", words_of(chart_.x), words_of(chart_.y),
                               join(mapped<std::string>(chart_.series, &Series::name), ", "));
    for (const std::string& note : notes) description += ' ' + note + '.';
    svg_ = fmt::format(
        R"(<svg id="{0}" class="chart" viewBox="0 0 {1} {2}" xmlns="http://www.w3.org/2000/svg" role="img" )"
        R"(aria-labelledby="{0}-title" aria-describedby="{0}-description" )"
        R"(font-family="system-ui, sans-serif" font-size="{3}" fill="currentColor"><title id="{0}-title">)"
        "{4}</title><desc id=\"{0}-description\">{5}</desc>\n",
        chart_.id, number(chart_width), number(layout_.height), number(font_size),
        xml_text(shown_text(chart_.title, most)), xml_text(shown_text(description, most)));
  }

  static std::string words_of(const Axis& axis) {
    return axis.label + (axis.logarithmic ? " (logarithmic)" : "");
  }

  double across(double x) const {
    return layout_.left + layout_.x.fraction(x) * (layout_.right - layout_.left);
  }
  double down(double y) const {
    return layout_.bottom - layout_.y.fraction(y) * (layout_.bottom - layout_.top);
  }

  static std::string at(double x, double y) { return number(x) + ',' + number(y); }

  /// `middle`: y of the middle of its capitals.
  void text(const std::string& shown, double x, double middle, const std::string& attributes = "") {
    svg_ += fmt::format("<text x=\"{}\" y=\"{}\"{}>{}</text>\n", number(x), number(middle + 0.35 * font_size),
                        attributes, xml_text(shown));
  }

  void grid_and_axes() {
    const double left = layout_.left, right = layout_.right, top = layout_.top, bottom = layout_.bottom;
    constexpr double tick_length = 5;
    std::string grid, axes = 'M' + at(left, top) + 'V' + number(bottom) + 'H' + number(right);
    for (const Tick& tick : layout_.y.ticks) {
      grid += 'M' + at(left, down(tick.value)) + 'H' + number(right);
      axes += 'M' + at(left, down(tick.value)) + 'h' + number(tick_length);
    }
    for (const Tick& tick : layout_.x.ticks) {
      grid += 'M' + at(across(tick.value), bottom) + 'V' + number(top);
      axes += 'M' + at(across(tick.value), bottom) + 'v' + number(-tick_length);
    }
    svg_ += path(grid, R"( fill="none" stroke="currentColor" stroke-opacity="0.2" stroke-width="0.7")");
    svg_ += path(axes, R"( fill="none" stroke="currentColor")");
  }

  void texts() {
    const std::string middle = R"( text-anchor="middle")", end = R"( text-anchor="end")";
    double y = chart_edge + line_height / 2;
    for (const std::string& line : layout_.title) {
      text(line, chart_edge, y, R"( font-weight="bold")");
      y += line_height;
    }
    for (const std::string& line : layout_.subtitle) {
      text(line, chart_edge, y);
      y += line_height;
    }
    text(layout_.y_label, chart_edge, layout_.y_label_middle);
    for (const Tick& tick : layout_.y.ticks) text(tick.label, layout_.left - 8, down(tick.value), end);
    for (std::size_t i = 0; i < layout_.x.ticks.size(); ++i)
      if (const auto row = layout_.tick_rows[i])
        text(layout_.x.ticks[i].label, across(layout_.x.ticks[i].value),
             layout_.tick_labels + *row * line_height, middle);
    text(layout_.x_label, (layout_.left + layout_.right) / 2, layout_.x_label_middle, middle);
  }

  /// A series and its entry in the legend.
  void series(std::size_t s) {
    const SeriesEntry& entry = layout_.legend[s];
    double y = entry.middle;
    for (const std::string& line : entry.lines) {
      text(line, entry.left + legend_sample - 6, y);
      y += line_height;
    }
    line_and_points(s, entry.left + 9, entry.middle);
  }

  void line_and_points(std::size_t s, double sample_x, double sample_y) {
    constexpr double sample_width = 36;
    const Series& one = chart_.series[s];
    const bool reference = one.origin == Origin::reference, published = one.origin == Origin::published;
    const std::size_t look = looks_[s];
    const std::string colour(reference ? "currentColor" : series_colours[look % series_colours.size()]);
    const bool marks = reference && one.mark != PointMark::none;
    const std::string_view shape = marks       ? mark_shapes[static_cast<std::size_t>(one.mark)]
                                   : reference ? std::string_view()
                                               : point_shapes[look % point_shapes.size()];
    std::string line = 'M' + at(sample_x, sample_y) + 'h' + number(sample_width), points;
    const auto add_point = [&](double x, double y) {
      if (!shape.empty()) points += 'M' + at(x, y) + std::string(shape);
    };
    add_point(sample_x + sample_width / 2, sample_y);
    for (const PlottedPoint& point : values_.series[s]) {
      const double x = across(point.x), y = down(point.y);
      line += (point.after_gap || &point == &values_.series[s].front() ? 'M' : 'L') + at(x, y);
      add_point(x, y);
    }
    const std::size_t repeat = look / point_shapes.size();
    const std::string_view dashes = reference   ? reference_dashes[look % reference_dashes.size()]
                                    : published ? published_dashes[repeat % published_dashes.size()]
                                                : measured_dashes[repeat % measured_dashes.size()];
    svg_ +=
        fmt::format("<g fill=\"none\" stroke=\"{}\" stroke-width=\"{}\">\n", colour, reference ? "1.5" : "2");
    if (reference ? !marks : chart_.form == ChartForm::lines)
      svg_ += path(line, attribute("stroke-dasharray", dashes));
    svg_ += path(intervals(s), attribute("stroke-width", "1.5"));
    svg_ += path(points, reference || published ? "" : fmt::format(R"( fill="{}" stroke="none")", colour));
    svg_ += "</g>\n";
  }

  std::string intervals(std::size_t s) const {
    constexpr double half_cap = 3.7;
    std::string d;
    for (const PlottedPoint& point : values_.series[s]) {
      if (!point.interval) continue;
      const double x = across(point.x), low = down(point.interval->low), high = down(point.interval->high);
      d += 'M' + at(x, low) + 'V' + number(high);
      for (const double end : {low, high}) d += 'M' + at(x - half_cap, end) + 'h' + number(2 * half_cap);
    }
    return d;
  }

  const Chart& chart_;
  const PlottedValues& values_;
  const ChartLayout& layout_;
  std::vector<std::size_t> looks_;
  std::string svg_;
};

void require_id(const std::string& id) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_more = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-'; };
  if (id.empty() || !is_letter(id.front()) || !std::ranges::all_of(id, is_more))
    throw std::invalid_argument(
        fmt::format("the id \"{}\" of a chart is not letters, digits and hyphens", printable(id)));
}

}  // namespace

DrawnChart draw_svg(const Chart& chart) {
  require_id(chart.id);
  const PlottedValues values = plotted_values(chart);
  DrawnChart drawn{{}, chart.remarks};
  drawn.notes.insert(drawn.notes.end(), values.notes.begin(), values.notes.end());
  if (const auto layout = chart_layout(chart, values))
    drawn.svg = Drawing(chart, values, *layout).made(drawn.notes);
  return drawn;
}

}  // namespace mssim
