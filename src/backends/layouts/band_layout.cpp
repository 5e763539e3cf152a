#include "backends/layouts/band_layout.h"

#include <algorithm>

namespace mssim {

BandLayout::BandLayout(const GridPatch& grid, std::size_t lane_count)
    : lanes(lane_count),
      rows(grid.rows),
      columns(grid.columns),
      height(std::max(halo, (rows + lanes - 1) / lanes)) {}

}  // namespace mssim
