#pragma once

#include <string>
#include <string_view>

#include "charts/chart.h"
#include "charts/chart_layout.h"
#include "charts/plotted_values.h"

namespace mssim {

/// What gnuplot is to do to draw the values: numbers in data blocks, texts by gnuplot_text() alone, the
/// result in the file `output` of the folder that it runs in. gnuplot's own patterns are as wide as a bar, so
/// bars are filled with the colour #0102NN, which stands for SeriesStyle::fill() NN. `values` must not be
/// empty.
std::string gnuplot_script(const Chart& chart, const PlottedValues& values, const ChartLayout& layout,
                           std::string_view output);

}  // namespace mssim
