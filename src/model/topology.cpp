#include "model/topology.h"

#include <array>
#include <cmath>

namespace mssim {

float GridPatch::rest_length(GridSpringKind kind) const {
  return static_cast<float>(spacing * std::sqrt(grid_spring_kinds[kind].length_squared));
}

std::uint64_t count_springs(std::uint64_t rows, std::uint64_t columns) {
  std::uint64_t count = 0;
  for (const GridSpring& spring : grid_stencil) {
    const auto down = static_cast<std::uint64_t>(spring.rows < 0 ? -spring.rows : spring.rows);
    const auto right = static_cast<std::uint64_t>(spring.columns);
    if (rows > down && columns > right) count += (rows - down) * (columns - right);
  }
  return count;
}

std::vector<Spring> springs_of(const GridPatch& grid) {
  std::vector<Spring> springs;
  springs.reserve(count_springs(grid.rows, grid.columns));
  std::array<float, grid_spring_kinds.size()> rest_length{};
  for (const GridSpringKind kind : {structural, shear, bending}) rest_length[kind] = grid.rest_length(kind);
  const std::int64_t rows = grid.rows, columns = grid.columns;
  for (std::int64_t row = 0; row < rows; ++row)
    for (std::int64_t column = 0; column < columns; ++column)
      for (const GridSpring& spring : grid_stencil) {
        const std::int64_t other_row = row + spring.rows, other_column = column + spring.columns;
        if (other_row < 0 || other_row >= rows || other_column >= columns) continue;
        springs.push_back({static_cast<std::uint32_t>(row * columns + column),
                           static_cast<std::uint32_t>(other_row * columns + other_column),
                           rest_length[spring.kind], spring.kind});
      }
  return springs;
}

}  // namespace mssim
