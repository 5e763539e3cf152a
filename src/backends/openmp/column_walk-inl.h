// The walk down one column of a banded cloth: every node updated as soon as the forces on it are complete.
// Compiled once per instruction set, so the guard toggles.
//
// Walking the columns from left to right and each from the top, a node meets its own springs last
// (row_forces-inl.h); nothing conflicts, and nothing behind the walk is read again, so the update may write
// over the state it was computed from.
#if defined(MSSIM_COLUMN_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_COLUMN_WALK_INL_H_
#undef MSSIM_COLUMN_WALK_INL_H_
#else
#define MSSIM_COLUMN_WALK_INL_H_
#endif

#include "backends/layouts/update_lanes-inl.h"
#include "backends/openmp/row_forces-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// One stage at the nodes of a row, once the force on them is complete. Forces are accelerations already.
template <std::size_t method, std::size_t stage>
HWY_INLINE void update_row(const RowConstants& constants, const ColumnView& column, const NodeLanes& node,
                           const Lanes3& force, std::ptrdiff_t row) {
  const std::ptrdiff_t lanes = static_cast<std::ptrdiff_t>(lane_count());
  const auto address = [&](Pair pair, std::size_t slot) MSSIM_INLINE_LAMBDA {
    return column.pairs[index(pair)] + row * 6 * lanes + static_cast<std::ptrdiff_t>(slot % 2) * 3 * lanes;
  };
  const Lanes gravity = hn::Load(FloatTag(), constants.of_row(row) + BandRows::gravity_vector * lane_count());
  update_lanes<method, stage>(
      node, force, EveryLane{}, gravity, constants.coefficients, constants.surroundings,
      [&](auto slot) MSSIM_INLINE_LAMBDA {
        constexpr std::size_t i = index(decltype(slot)::value);
        return load3(
            address(storage_of(integrators[method], static_cast<Pair>(i / 2), Storage::in_place), i));
      },
      [&](auto slot, const Lanes3& value) MSSIM_INLINE_LAMBDA {
        constexpr std::size_t i = index(decltype(slot)::value);
        store3(address(walk_writes_to(integrators[method], stage, static_cast<Pair>(i / 2)), i), value);
      });
}

/// The springs of a row that are to be looked at, of a column of so many rows: of halo rows those that reach
/// into the column or the next one.
HWY_INLINE unsigned springs_of_row(std::ptrdiff_t row, std::ptrdiff_t height) {
  if (row == -2) return down_2;
  if (row == -1) return within_column | right_down;
  return row == height ? right_up : every_spring;
}

/// The springs of `set` of a column, whatever the stage. It asks in every row what there is to do. Where
/// `complete`, the forces on the column's nodes are so now, and take the place of those from earlier columns.
HWY_NOINLINE inline void pull_rows(const BandGrid& bands, const ColumnView& view, unsigned set,
                                   bool complete) {
  const RowConstants constants(bands);
  const ColumnView column = view;
  const auto height = static_cast<std::ptrdiff_t>(bands.layout.height);
  const auto write_halo_rows = [&](float* of) HWY_ATTR {
    for (const std::ptrdiff_t row : {-2, -1}) write_row_above(of, height, row);
    for (const std::ptrdiff_t row : {height, height + 1}) write_row_below(of, height, row);
  };
  write_halo_rows(column.here);
  if ((set & to_next_column) != 0) write_halo_rows(column.next);
  Carry carry = nothing_carried();
  for (std::ptrdiff_t row = -2; row <= height; ++row) {
    const bool inside = complete && row >= 0 && row < height;
    const Lanes3 force = pull_row<false>(constants, column, nodes_of(column.here, row),
                                         set & springs_of_row(row, height), {}, inside, carry, row);
    if (inside) store3(column.forces_here + row * static_cast<std::ptrdiff_t>(3 * lane_count()), force);
  }
}

/// Forces of springs that reach across the end of a band, of its last two rows.
struct EndForces {
  KnownForces last_but_one, last;
};

/// A lane's last rows are the halo rows above the next lane's band: their forces are found once, here, for
/// the rows that own the springs and, a lane further, for those at the top. The halo rows' own springs would
/// give the same.
HWY_INLINE EndForces forces_across_ends(const RowConstants& constants, const ColumnView& column) {
  const auto force = [&](const NodeLanes& node, const NodeLanes& other, std::ptrdiff_t row,
                         SpringSet spring) MSSIM_INLINE_LAMBDA {
    return force_of(begin_spring(node, other), spring_of_row(constants.of_row(row), spring));
  };
  const std::ptrdiff_t last = constants.height - 1, last_but_one = constants.height - 2;
  EndForces ends;
  const NodeLanes end = nodes_of(column.here, last), below = of_lane_behind(nodes_of(column.here, 0));
  ends.last_but_one.set = down_2;
  ends.last_but_one.down_2 = force(nodes_of(column.here, last_but_one), below, last_but_one, down_2);
  ends.last.set = down | down_2 | right_down;
  ends.last.down = force(end, below, last, down);
  ends.last.down_2 = force(end, of_lane_behind(nodes_of(column.here, 1)), last, down_2);
  ends.last.right_down = force(end, of_lane_behind(nodes_of(column.next, 0)), last, right_down);
  return ends;
}

/// A column whose nodes own all springs and are updated: all but a few.
template <std::size_t method, std::size_t stage>
HWY_NOINLINE void walk_inner_column(const BandGrid& bands, const ColumnView& view) {
  constexpr bool gathers_state = integrators[method].stages[stage].gather == Pair::state;
  const RowConstants constants(bands);
  const ColumnView column = view;
  const auto height = constants.height, force_floats = static_cast<std::ptrdiff_t>(3 * lane_count());
  write_row_above(column.next, height, -1);  // for the spring from row 0 up to the right
  const EndForces ends = forces_across_ends(constants, column);
  const Lanes none(0.0F);
  Carry carry{
      .below = from_lane_before(ends.last_but_one.down_2, none) + from_lane_before(ends.last.down, none),
      .below_2 = from_lane_before(ends.last.down_2, none),
      .right_below = from_lane_before(ends.last.right_down, none),
      .right_above = zero3()};
  const auto walk_row = [&](std::ptrdiff_t row, const KnownForces& known) MSSIM_INLINE_LAMBDA {
    const NodeLanes node = nodes_of(column.here, row);
    const Lanes3 force =
        pull_row<gathers_state>(constants, column, node, every_spring, known, true, carry, row);
    update_row<method, stage>(constants, column, node, force, row);
  };
  for (std::ptrdiff_t row = 0; row < height - 2; ++row) walk_row(row, {});
  walk_row(height - 2, ends.last_but_one);
  walk_row(height - 1, ends.last);
  // The spring from a band's first row up to the right reaches the last row of the lane before.
  store3(column.forces_next + (height - 1) * force_floats,
         carry.right_above + from_lane_behind(load3(column.forces_next + height * force_floats), none));
}

/// A column near the end of the cloth or of the partition. `set`: springs of its nodes that exist and matter.
template <std::size_t method, std::size_t stage>
HWY_NOINLINE void walk_edge_column(const BandGrid& bands, const ColumnView& view, unsigned set, bool update) {
  pull_rows(bands, view, set, update);
  if (!update) return;
  const RowConstants constants(bands);
  const ColumnView column = view;
  const auto height = static_cast<std::ptrdiff_t>(bands.layout.height);
  for (std::ptrdiff_t row = 0; row < height; ++row)
    update_row<method, stage>(constants, column, nodes_of(column.here, row),
                              load3(column.forces_here + row * static_cast<std::ptrdiff_t>(3 * lane_count())),
                              row);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
