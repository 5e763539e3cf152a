#pragma once

#include <vector>

#include "picture/ticks.h"

namespace mssim {

/// The part of an axis that a chart shows.
struct AxisScale {
  double low, high;  ///< low < high
  std::vector<Tick> ticks;
};

/// A scale with a little room beside the finite values from `low` to `high`, which begins at zero if it would
/// begin near it.
AxisScale linear_scale(double low, double high);

/// A scale from 0 on, or to 0: bars compare by their lengths.
AxisScale scale_from_zero(double low, double high);

/// A logarithmic one of positive values: ticks at powers of ten, in between too where there are few.
AxisScale logarithmic_scale(double low, double high);

}  // namespace mssim
