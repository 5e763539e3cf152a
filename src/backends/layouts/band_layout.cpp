#include "backends/layouts/band_layout.h"

#include <algorithm>

namespace mssim {

BandLayout::BandLayout(const GridPatch& grid, std::size_t lane_count, std::size_t half_count)
    : lanes(lane_count),
      halves(half_count),
      bands(lanes / halves),
      rows(grid.rows),
      columns(grid.columns),
      height(std::max(halo, (rows + bands - 1) / bands)) {}

}  // namespace mssim
