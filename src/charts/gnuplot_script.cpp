#include "charts/gnuplot_script.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "charts/chart_text.h"
#include "charts/series_style.h"
#include "text/text.h"

namespace mssim {
namespace {

/// gnuplot's numbers of point shapes, for filled and open ones.
constexpr std::array<int, point_shapes> filled_points{7, 5, 9, 13, 11, 15}, open_points{6, 4, 8, 12, 10, 14};

/// Those of marks, and how large they are.
struct MarkShape {
  int point;
  std::string_view size;
};
constexpr std::array<MarkShape, 4> mark_shapes{{{0, "0"}, {6, "1.8"}, {4, "1.8"}, {2, "1.1"}}};

/// Dashes, in lengths of strokes and gaps.
constexpr std::array<std::string_view, line_dashes> measured_dashes{"solid", "(9,4)"},
    published_dashes{"(4,3)", "(4,3,1,3)"};
constexpr std::array<std::string_view, 4> reference_dashes{"solid", "(2,3)", "(10,3,2,3)", "(14,4)"};

/// What stands for a fill until page_svg() draws its pattern.
std::string fill_colour(std::size_t fill) { return "#0102" + to_hex(fill).substr(14); }

class Script {
 public:
  Script(const Chart& chart, const PlottedValues& values, const ChartLayout& layout)
      : chart_(chart),
        values_(values),
        layout_(layout),
        styles_(series_styles(chart.series, chart.families)) {}

  std::string made(std::string_view output) {
    line("set encoding utf8");
    line("set terminal svg size ", decimal(chart_width), ',', decimal(layout_.height),
         " dynamic noenhanced butt font 'sans-serif,", std::to_string(font_size), "' name 'chart'");
    line("set output ", gnuplot_text(output));
    frame();
    texts();
    legend();
    for (std::size_t s = 0; s < chart_.series.size(); ++s) data(s);
    std::string plots;
    for (std::size_t s = 0; s < chart_.series.size(); ++s)
      for (const std::string& plot : plots_of(s)) plots += (plots.empty() ? "" : ", ") + plot;
    line("plot ", plots);
    line("unset output");
    return std::move(script_);
  }

 private:
  template <class... Parts>
  void line(const Parts&... parts) {
    ((script_ += parts), ...);
    script_ += '\n';
  }

  /// gnuplot counts from 0 on the left to 1 on the right, and from 0 below to 1 above.
  static std::string across(double x) { return decimal(x / chart_width); }
  std::string up(double y) const { return decimal(1 - y / layout_.height); }
  std::string on_screen(double x, double y) const { return "screen " + across(x) + ", screen " + up(y); }

  void axis(char name, const Axis& axis, const AxisScale& scale) {
    line("set ", name, "range [", decimal(scale.low), ':', decimal(scale.high), ']');
    if (axis.logarithmic) line("set logscale ", name);
    std::string ticks;
    for (const Tick& tick : scale.ticks)
      ticks += (ticks.empty() ? "" : ", ") + gnuplot_text(tick.label) + ' ' + decimal(tick.value);
    line("set ", name, "tics nomirror scale 0.5 (", ticks, ')');
  }

  void frame() {
    line("set lmargin at screen ", across(layout_.left));
    line("set rmargin at screen ", across(layout_.right));
    line("set tmargin at screen ", up(layout_.top));
    line("set bmargin at screen ", up(layout_.bottom));
    line("set border 3 lw 1");
    axis('y', chart_.y, layout_.y);
    if (chart_.form == ChartForm::bars) {
      line("set xrange [", decimal(layout_.x.low), ':', decimal(layout_.x.high), ']');
      line("unset xtics");
    } else {
      axis('x', chart_.x, layout_.x);
    }
    line("set grid xtics ytics linetype 1 linewidth 0.7 linecolor rgb 'gray'");
    line("set errorbars 0.7");
  }

  void label(const std::string& text, const std::string& place, std::string_view more) {
    line("set label ", gnuplot_text(text), " at ", place, ' ', more);
  }

  void texts() {
    double y = chart_edge + line_height / 2;
    for (const std::string& text : layout_.title) {
      label(text, on_screen(chart_edge, y), "left font 'sans-serif:Bold'");
      y += line_height;
    }
    label(layout_.y_label, on_screen(chart_edge, layout_.y_label_middle), "left");
    label(layout_.x_label, on_screen((layout_.left + layout_.right) / 2, layout_.x_label_middle), "center");
    for (std::size_t group = 0; group < layout_.groups.size(); ++group) {
      const std::string place = "first " + std::to_string(group) + ", screen " + up(layout_.group_labels);
      label(layout_.groups[group], place, layout_.groups_tilted ? "right rotate by 35" : "center");
    }
  }

  void legend() {
    line("set key at ", on_screen(chart_edge, layout_.legend),
         " left top Left reverse vertical samplen 2.5 maxcols ", std::to_string(layout_.legend_columns),
         " maxrows ", std::to_string(layout_.legend_rows));
  }

  /// Left and right end of the bars of a series in a group.
  Interval bar(std::size_t series, double group) const {
    const double width = 0.84 / static_cast<double>(chart_.series.size());
    const double left = group - 0.42 + width * static_cast<double>(series);
    return {left, left + width * 0.92};
  }

  double x_of(std::size_t series, const PlottedPoint& point) const {
    if (chart_.form != ChartForm::bars) return point.x;
    const Interval ends = bar(series, point.x);
    return (ends.low + ends.high) / 2;
  }

  /// The points of a series as the data block $sN, and their intervals as $iN.
  void data(std::size_t s) {
    line("$s", std::to_string(s), " << EOD");
    for (const PlottedPoint& point : values_.series[s]) {
      if (point.after_gap) line("");
      std::string columns = decimal(x_of(s, point)) + ' ' + decimal(point.y);
      if (chart_.form == ChartForm::bars) {
        const Interval ends = bar(s, point.x);
        const double foot = chart_.y.logarithmic ? layout_.y.low : 0;
        for (const double column : {ends.low, ends.high, foot, point.y}) columns += ' ' + decimal(column);
      }
      line(columns);
    }
    line("EOD");
    line("$i", std::to_string(s), " << EOD");
    for (const PlottedPoint& point : values_.series[s])
      if (point.interval)
        line(decimal(x_of(s, point)), ' ', decimal(point.y), ' ', decimal(point.interval->low), ' ',
             decimal(point.interval->high));
    line("EOD");
  }

  /// What gnuplot plots of a series, which may be nothing.
  std::vector<std::string> plots_of(std::size_t s) const {
    const std::vector<PlottedPoint>& points = values_.series[s];
    if (points.empty()) return {};
    const std::string number = std::to_string(s);
    std::vector<std::string> plots{"$s" + number + " using " + look(s) + " title " +
                                   gnuplot_text(layout_.names[s])};
    if (std::ranges::any_of(points, [](const PlottedPoint& point) { return point.interval.has_value(); }))
      plots.push_back("$i" + number + " using 1:2:3:4 with yerrorbars linewidth 1.5 pointtype 0" +
                      colour(chart_.form == ChartForm::bars ? "black" : styles_[s].colour()) + " notitle");
    return plots;
  }

  /// The columns of a series and how they are drawn.
  std::string look(std::size_t s) const {
    const SeriesStyle& style = styles_[s];
    if (const PointMark mark = chart_.series[s].mark;
        style.origin == Origin::reference && mark != PointMark::none) {
      const MarkShape& shape = mark_shapes[static_cast<std::size_t>(mark)];
      return "1:2 with points linewidth 1.5" + colour("black") + " pointtype " + std::to_string(shape.point) +
             " pointsize " + std::string(shape.size);
    }
    if (style.origin == Origin::reference)
      return "1:2 with lines linewidth 1.5" + colour("black") + " dashtype " +
             std::string(reference_dashes[style.family % reference_dashes.size()]);
    if (chart_.form == ChartForm::bars)
      return "1:2:3:4:5:6 with boxxyerror linewidth 1.5" + colour(fill_colour(style.fill())) +
             " fillstyle solid 1 border" + colour(style.colour());
    const bool published = style.origin == Origin::published;
    const int shape = (published ? open_points : filled_points)[style.shape()];
    std::string look = "1:2 with points";
    if (chart_.form == ChartForm::lines)
      look = "1:2 with linespoints dashtype " +
             std::string((published ? published_dashes : measured_dashes)[style.dashes()]);
    return look + " linewidth 2" + colour(style.colour()) + " pointtype " + std::to_string(shape) +
           " pointsize 0.9";
  }

  static std::string colour(std::string_view name) { return " linecolor rgb '" + std::string(name) + "'"; }

  const Chart& chart_;
  const PlottedValues& values_;
  const ChartLayout& layout_;
  std::vector<SeriesStyle> styles_;
  std::string script_;
};

}  // namespace

std::string gnuplot_script(const Chart& chart, const PlottedValues& values, const ChartLayout& layout,
                           std::string_view output) {
  return Script(chart, values, layout).made(output);
}

}  // namespace mssim
