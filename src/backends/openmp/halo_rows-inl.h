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

/// Floats of a row of nodes, and nodes of a row, in a column of a pair whose row 0 begins at `column`.
HWY_INLINE std::ptrdiff_t row_floats() { return static_cast<std::ptrdiff_t>(6 * lane_count()); }
HWY_INLINE NodeLanes nodes_of(const float* column, std::ptrdiff_t row) {
  const float* nodes = column + row * row_floats();
  return {load3(nodes), load3(nodes + row_floats() / 2)};
}

/// In a component of a node that is not there: far from all nodes, because springs without stiffness reach
/// it, which must not have length zero.
constexpr float far_away = 1e9F;

/// The row that the lane before each has in these places.
HWY_INLINE NodeLanes of_lane_before(const NodeLanes& row) {
  const Lanes none(far_away);
  return {
      {from_lane_before(row.x.x, none), from_lane_before(row.x.y, none), from_lane_before(row.x.z, none)},
      {from_lane_before(row.v.x, none), from_lane_before(row.v.y, none), from_lane_before(row.v.z, none)}};
}
/// The row that the lane behind each has in these places.
HWY_INLINE NodeLanes of_lane_behind(const NodeLanes& row) {
  const Lanes none(far_away);
  return {
      {from_lane_behind(row.x.x, none), from_lane_behind(row.x.y, none), from_lane_behind(row.x.z, none)},
      {from_lane_behind(row.v.x, none), from_lane_behind(row.v.y, none), from_lane_behind(row.v.z, none)}};
}

/// Writes row -1 or -2 of a column of so many rows.
HWY_INLINE void write_row_above(float* column, std::ptrdiff_t height, std::ptrdiff_t row) {
  const NodeLanes nodes = of_lane_before(nodes_of(column, height + row));
  store3(column + row * row_floats(), nodes.x);
  store3(column + row * row_floats() + row_floats() / 2, nodes.v);
}
/// Writes row `height` or the one after it.
HWY_INLINE void write_row_below(float* column, std::ptrdiff_t height, std::ptrdiff_t row) {
  const NodeLanes nodes = of_lane_behind(nodes_of(column, row - height));
  store3(column + row * row_floats(), nodes.x);
  store3(column + row * row_floats() + row_floats() / 2, nodes.v);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
