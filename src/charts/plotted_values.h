#pragma once

#include <optional>
#include <string>
#include <vector>

#include "charts/chart.h"

namespace mssim {

/// No axis goes beyond this, nor a logarithmic one below its inverse: the room beside values must be finite.
inline constexpr double largest_plotted = 1e300;

struct Interval {
  double low, high;
};

/// A value that can be drawn.
struct PlottedPoint {
  double x, y;  ///< of bars, x is the number of the group, from 0
  std::optional<Interval> interval;
  bool after_gap = false;  ///< values between the point before and this one were left out
};

/// What of a chart's series can be drawn.
struct PlottedValues {
  std::vector<std::vector<PlottedPoint>> series;  ///< one for each of the chart's, in its order
  std::vector<std::string> notes;                 ///< what was left out, a sentence for each such series

  bool empty() const;
  /// The smallest interval that has all of them, along x, and along y with their intervals. Not for none.
  Interval x_range() const;
  Interval y_range() const;
};

/// Leaves out what chart.h says. Throws std::invalid_argument where the numbers of values disagree.
PlottedValues plotted_values(const Chart& chart);

}  // namespace mssim
