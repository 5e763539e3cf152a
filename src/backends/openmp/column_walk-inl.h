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

/// Forces of springs that reach across the end of a band, of its last two rows.
struct EndForces {
  KnownForces last_but_one, last;
};

/// A lane's last rows are the rows above the next lane's band: the forces of those springs of `set` that
/// reach across are found once, here, for the rows that own the springs and, a lane further, for those at the
/// top.
template <unsigned set>
HWY_INLINE EndForces forces_across_ends(const RowConstants& constants, const ColumnView& column) {
  const auto force = [&](const NodeLanes& node, const NodeLanes& other, std::ptrdiff_t row,
                         SpringSet spring) MSSIM_INLINE_LAMBDA {
    return force_of(begin_spring(node, other), spring_of_row(constants.of_row(row), spring));
  };
  const auto below_band = [&](const float* of, std::ptrdiff_t row) MSSIM_INLINE_LAMBDA {
    return of_lane_behind(nodes_of(of, row), constants.bands);
  };
  const std::ptrdiff_t last = constants.height - 1, last_but_one = constants.height - 2;
  EndForces ends;
  const NodeLanes end = nodes_of(column.here, last);
  if constexpr ((set & within_column) != 0) {
    const NodeLanes below = below_band(column.here, 0);
    ends.last_but_one.set |= down_2;
    ends.last_but_one.down_2 = force(nodes_of(column.here, last_but_one), below, last_but_one, down_2);
    ends.last.set |= within_column;
    ends.last.down = force(end, below, last, down);
    ends.last.down_2 = force(end, below_band(column.here, 1), last, down_2);
  }
  if constexpr ((set & right_down) != 0) {
    ends.last.set |= right_down;
    ends.last.right_down = force(end, below_band(column.next, 0), last, right_down);
  }
  return ends;
}

/// Takes the springs of `set` of a column further, row by row. act(row, node, force): the force of springs of
/// this and, if `received`, of earlier columns on a row's nodes. `prefetch`: as pull_row.
template <unsigned set, bool prefetch, bool received, class Act>
HWY_INLINE void walk_rows(const RowConstants& constants, const ColumnView& column, Act act) {
  const auto height = constants.height, force_floats = static_cast<std::ptrdiff_t>(3 * lane_count());
  if constexpr ((set & right_up) != 0)  // from row 0
    write_row_above(column.next, height, constants.bands);
  const EndForces ends = forces_across_ends<set>(constants, column);
  const Lanes none(0.0F);
  const auto of_band_before = [&](const Lanes3& force) MSSIM_INLINE_LAMBDA {
    return from_lane_before(force, none, constants.bands);
  };
  Carry carry = nothing_carried();
  if constexpr ((set & within_column) != 0) {
    carry.below = of_band_before(ends.last_but_one.down_2) + of_band_before(ends.last.down);
    carry.below_2 = of_band_before(ends.last.down_2);
  }
  if constexpr ((set & right_down) != 0) carry.right_below = of_band_before(ends.last.right_down);
  const auto walk_row = [&](std::ptrdiff_t row, const KnownForces& known) MSSIM_INLINE_LAMBDA {
    const NodeLanes node = nodes_of(column.here, row);
    act(row, node, pull_row<prefetch>(constants, column, node, set, known, received, carry, row));
  };
  for (std::ptrdiff_t row = 0; row < height - 2; ++row) walk_row(row, {});
  walk_row(height - 2, ends.last_but_one);
  walk_row(height - 1, ends.last);
  // The spring from a band's first row up to the right reaches the last row of the lane before.
  if constexpr ((set & right_up) != 0)
    store3(column.forces_next + (height - 1) * force_floats,
           carry.right_above +
               from_lane_behind(load3(column.forces_next + height * force_floats), none, constants.bands));
}

/// A column whose nodes own all springs and are updated: all but a few.
template <std::size_t method, std::size_t stage>
HWY_NOINLINE void walk_inner_column(const BandGrid& bands, const ColumnView& view) {
  constexpr bool gathers_state = integrators[method].stages[stage].gather == Pair::state;
  const RowConstants constants(bands, view);
  const ColumnView column = view;
  walk_rows<every_spring, gathers_state, true>(
      constants, column,
      [&](std::ptrdiff_t row, const NodeLanes& node, const Lanes3& force)
          MSSIM_INLINE_LAMBDA { update_row<method, stage>(constants, column, node, force, row); });
}

/// A column before those that are updated, on which its springs of `set` act, whatever the stage.
template <unsigned set>
HWY_NOINLINE void walk_column_before(const BandGrid& bands, const ColumnView& view) {
  const RowConstants constants(bands, view);
  const ColumnView column = view;
  walk_rows<set, false, false>(constants, column,
                               [](std::ptrdiff_t, const NodeLanes&, const Lanes3&) MSSIM_INLINE_LAMBDA {});
}

/// A column at the end of the cloth, without springs that would reach beyond, whatever the stage: the forces
/// on its nodes, which are complete now, take the place of those from earlier columns.
template <unsigned set>
HWY_NOINLINE void pull_last_column(const BandGrid& bands, const ColumnView& view) {
  const RowConstants constants(bands, view);
  const ColumnView column = view;
  walk_rows<set, false, true>(
      constants, column, [&](std::ptrdiff_t row, const NodeLanes&, const Lanes3& force) MSSIM_INLINE_LAMBDA {
        store3(column.forces_here + row * static_cast<std::ptrdiff_t>(3 * lane_count()), force);
      });
}

/// A column at the end of the cloth, behind which there are so few others.
template <std::size_t method, std::size_t stage>
HWY_NOINLINE void walk_last_column(const BandGrid& bands, const ColumnView& view, std::size_t behind) {
  if (behind == 0)
    pull_last_column<within_column>(bands, view);
  else
    pull_last_column<within_column | to_next_column>(bands, view);
  const RowConstants constants(bands, view);
  const ColumnView column = view;
  for (std::ptrdiff_t row = 0; row < constants.height; ++row)
    update_row<method, stage>(constants, column, nodes_of(column.here, row),
                              load3(column.forces_here + row * static_cast<std::ptrdiff_t>(3 * lane_count())),
                              row);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
