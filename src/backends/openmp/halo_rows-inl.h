// Rows of a banded cloth as the lanes beside them see them: row -1 of a lane is the last row of the lane
// before it. They are made where they are read, mostly in registers: kept with every column that is written,
// they took 95 cycles a column on an Intel Xeon. Compiled once per instruction set, so the guard toggles.
#if defined(MSSIM_HALO_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_HALO_ROWS_INL_H_
#undef MSSIM_HALO_ROWS_INL_H_
#else
#define MSSIM_HALO_ROWS_INL_H_
#endif

#include "backends/vectors/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// Floats of a row of nodes.
HWY_INLINE std::ptrdiff_t row_floats() { return static_cast<std::ptrdiff_t>(6 * lane_count()); }

/// The nodes of a row in a column of a pair whose row 0 begins at `column`.
HWY_INLINE NodeLanes nodes_of(const float* column, std::ptrdiff_t row) {
  const float* nodes = column + row * row_floats();
  return {load3(nodes), load3(nodes + row_floats() / 2)};
}
HWY_INLINE void store_nodes(const NodeLanes& nodes, float* column, std::ptrdiff_t row) {
  float* to = column + row * row_floats();
  store3(to, nodes.x);
  store3(to + row_floats() / 2, nodes.v);
}

/// In a component of a node that is not there: far from all nodes, because springs without stiffness reach
/// it, which must not have length zero.
constexpr float far_away = 1e9F;

/// A row of which each lane has what the lane before, or behind, it has in this one.
HWY_INLINE NodeLanes of_lane_before(const NodeLanes& row, std::size_t bands) {
  return {from_lane_before(row.x, far_away, bands), from_lane_before(row.v, far_away, bands)};
}
HWY_INLINE NodeLanes of_lane_behind(const NodeLanes& row, std::size_t bands) {
  return {from_lane_behind(row.x, far_away, bands), from_lane_behind(row.v, far_away, bands)};
}

/// Writes row -1 of a column of so many rows.
HWY_INLINE void write_row_above(float* column, std::ptrdiff_t height, std::size_t bands) {
  store_nodes(of_lane_before(nodes_of(column, height - 1), bands), column, -1);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
