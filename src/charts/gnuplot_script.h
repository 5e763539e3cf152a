#pragma once

#include <string>
#include <string_view>

#include "charts/chart.h"
#include "charts/chart_layout.h"
#include "charts/plotted_values.h"

namespace mssim {

/// Bars are filled with a colour that stands for the look of a series, #0102NN: gnuplot's own patterns are as
/// wide as a bar. NN is its number in hexadecimal, and odd for published values.
inline constexpr std::string_view fill_colour_prefix = "#0102";

/// What gnuplot is to do to draw the values: numbers in data blocks, texts by gnuplot_text() alone, the
/// result in the file `output` of the folder that it runs in. `values` must not be empty.
std::string gnuplot_script(const Chart& chart, const PlottedValues& values, const ChartLayout& layout,
                           std::string_view output);

}  // namespace mssim
