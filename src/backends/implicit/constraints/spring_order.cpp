#include "backends/implicit/constraints/spring_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <variant>
#include <vector>

namespace mssim {
namespace {

ClothColour colour_of(const GridPatch& grid, const Spring& spring) {
  const auto [first, second] = std::minmax(spring.first, spring.second);
  const std::uint32_t row = first / grid.columns, column = first % grid.columns;
  const bool odd_row = row % 2 != 0;
  if (second / grid.columns == row) {  // to the right
    if (spring.kind == bending) return column % 4 < 2 ? bending_from_columns_01 : bending_from_columns_23;
    return column % 2 == 0 ? structural_from_even_columns : structural_from_odd_columns;
  }
  if (spring.kind == bending) return row % 4 < 2 ? bending_below_rows_01 : bending_below_rows_23;
  if (spring.kind == structural) return odd_row ? structural_below_odd_rows : structural_below_even_rows;
  if (second % grid.columns > column) return odd_row ? falling_below_odd_rows : falling_below_even_rows;
  return odd_row ? rising_below_odd_rows : rising_below_even_rows;
}

}  // namespace

SpringColouring spring_order(const System& system) {
  const auto* grid = std::get_if<GridPatch>(&system.topology);
  if (grid == nullptr) return colour_springs(system.springs, system.nodes());
  std::array<std::size_t, cloth_colours> next{};  // place of each colour's next spring
  for (const Spring& spring : system.springs) ++next[colour_of(*grid, spring)];
  SpringColouring order{std::vector<Spring>(system.springs.size()), {0}};
  for (std::size_t& place : next) {
    order.first.push_back(order.first.back() + place);
    place = order.first[order.first.size() - 2];
  }
  for (const Spring& spring : system.springs) order.springs[next[colour_of(*grid, spring)]++] = spring;
  return order;
}

}  // namespace mssim
