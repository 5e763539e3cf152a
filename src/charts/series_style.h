#pragma once

#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "charts/chart.h"

namespace mssim {

/// Colours of series, each with a contrast of at least 3 to 1 on white and on near-black (WCAG 2.2, 1.4.11),
/// so that a chart needs none of its own for dark pages.
inline constexpr std::array<std::string_view, 8> series_colours{"#2f7ed8", "#b8720a", "#2e8f57", "#d9534f",
                                                                "#9b59b6", "#12858c", "#c2508a", "#8a7a00"};

/// Shapes of points (circle, square, triangles, diamond, pentagon), and patterns of bars.
inline constexpr std::size_t point_shapes = 6, bar_patterns = 6;

/// Lines of measured, and of published, values that differ by their dashes.
inline constexpr std::size_t line_dashes = 2;

/// Combinations of colour and shape, or colour and pattern, that differ.
inline constexpr std::size_t looks = std::lcm(series_colours.size(), bar_patterns);

/// How a series looks beside others. Numbers count from 0; those of families go on beyond the colours, shapes
/// and patterns, of which there are different numbers.
struct SeriesStyle {
  std::size_t family = 0;
  Origin origin = Origin::measured;

  std::string_view colour() const { return series_colours[family % series_colours.size()]; }
  std::size_t shape() const { return family % point_shapes; }
  /// The dash of a line, another one after all shapes: twice as many differ without colours.
  std::size_t dashes() const { return family / point_shapes % line_dashes; }
  std::size_t pattern() const { return family % bar_patterns; }
  /// The fill of bars: a number for colour, pattern and origin.
  std::size_t fill() const { return 2 * (family % looks) + (origin == Origin::published ? 1 : 0); }
};

/// The style that has this fill().
inline SeriesStyle style_of_fill(std::size_t fill) {
  return {fill / 2, fill % 2 == 0 ? Origin::measured : Origin::published};
}

/// One for each series; no two are the same but those of equal marks. The families `fixed` have the first
/// numbers, whether they occur or not. References that are lines have a numbering of their own.
std::vector<SeriesStyle> series_styles(std::span<const Series> series,
                                       std::span<const std::string> fixed = {});

}  // namespace mssim
