#include "backends/implicit/nodes/node_rows.h"

#include <algorithm>

namespace mssim {

NodeRows::NodeRows(const System& system, const GridPatch& grid, std::size_t lanes)
    : layout(grid, lanes),
      slope_layout(grid, lanes),
      plane(grid, lanes),
      springs(spring_constants_of(system, grid)),
      surroundings(surroundings_of(system)),
      nodes(system.nodes()),
      mass(system.node_mass.front()),
      free(plane.floats()),
      row_is_free(grid.rows, 1),
      chunks(balanced_node_chunks(grid.rows, [](std::size_t row) { return row; })) {
  for (std::size_t row = 0; row < grid.rows; ++row)
    std::fill_n(free.data() + plane.offset(row, 0), grid.columns, 1.0F);
  for (const std::uint32_t pin : system.pins) {
    free.data()[plane.offset(pin / grid.columns, pin % grid.columns)] = 0;
    row_is_free[pin / grid.columns] = 0;
  }
}

}  // namespace mssim
