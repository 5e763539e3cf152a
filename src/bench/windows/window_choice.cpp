#include "bench/windows/window_choice.h"

#include <algorithm>
#include <cmath>

#include "backends/layouts/column_range.h"

namespace mssim {
namespace {

/// Rows and columns of a window where the cloth is large. What the reference computes around it costs more.
constexpr std::uint32_t usual_side = 128;
constexpr std::uint32_t least_side = 8;
/// Windows of a small cloth are so many times in its shorter side.
constexpr std::uint32_t windows_a_side = 8;

bool overlap(const GridWindow& a, const GridWindow& b) {
  return a.row < b.row + b.rows && b.row < a.row + a.rows && a.column < b.column + b.columns &&
         b.column < a.column + a.columns;
}

/// The i-th of numbers from 0 to 1 of which any first few lie evenly: the fractions of multiples of `step`.
double spread(std::size_t i, double step) {
  const double multiple = step * static_cast<double>(i + 1);
  return multiple - std::floor(multiple);
}

// Powers of the root of x^3 = x + 1, whose multiples fill a square evenly.
constexpr double row_step = 0.7548776662466927, column_step = 0.5698402909980532;

}  // namespace

std::vector<GridWindow> choose_windows(const GridPatch& grid, std::size_t parts,
                                       std::optional<std::uint32_t> pinned_row, std::size_t count) {
  const std::uint32_t side =
      std::clamp(std::min(grid.rows, grid.columns) / windows_a_side, least_side, usual_side);
  const std::uint32_t rows = std::min(side, grid.rows), columns = std::min(side, grid.columns);
  const std::uint32_t last_row = grid.rows - rows, last_column = grid.columns - columns;
  std::vector<GridWindow> chosen;
  const auto place = [&](std::uint32_t row, std::uint32_t column) {
    const GridWindow window{std::min(row, last_row), std::min(column, last_column), rows, columns};
    if (chosen.size() >= count ||
        std::ranges::any_of(chosen, [&](const GridWindow& other) { return overlap(window, other); }))
      return false;
    chosen.push_back(window);
    return true;
  };
  const auto row_at = [&](std::size_t i) {
    return static_cast<std::uint32_t>(spread(i, row_step) * (last_row + 1.0));
  };
  const auto around = [](std::size_t middle, std::uint32_t length) {
    return static_cast<std::uint32_t>(middle - std::min<std::size_t>(middle, length / 2));
  };
  place(0, 0);
  place(last_row, last_column);
  constexpr std::size_t tries = 16;
  for (std::size_t part = 1; part < parts; ++part) {
    const std::size_t seam = part_of({0, grid.columns}, part, parts).first;
    for (std::size_t i = 0; i < tries && !place(row_at(part + i), around(seam, columns)); ++i) continue;
  }
  if (pinned_row) place(around(*pinned_row, rows), around(grid.columns / 2, columns));
  place(0, last_column);
  place(last_row, 0);
  for (std::size_t i = 0; i < tries * count && chosen.size() < count; ++i)
    place(row_at(i), static_cast<std::uint32_t>(spread(i, column_step) * (last_column + 1.0)));
  return chosen;
}

}  // namespace mssim
