// The walk down one column of a banded cloth: every spring computed once, every node updated as soon as the
// forces on it are complete. Compiled once per instruction set, so the guard toggles.
//
// A spring belongs to its upper or left end (grid_stencil). Its force on the other end is kept: in registers
// for the rows below, in two columns of forces for the two columns to the right. The columns are walked from
// left to right and each from the top, so a node's own springs are its last; nothing conflicts, and nothing
// behind the walk is read again, so the update may overwrite the state that it was computed from.
#if defined(MSSIM_COLUMN_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_COLUMN_WALK_INL_H_
#undef MSSIM_COLUMN_WALK_INL_H_
#else
#define MSSIM_COLUMN_WALK_INL_H_
#endif

#include <hwy/cache_control.h>

#include <bit>
#include <limits>

#include "backends/layouts/band_grid.h"
#include "backends/layouts/node_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
inline namespace MSSIM_PRECISION {

/// Numbers of a row of nodes.
HWY_INLINE std::ptrdiff_t row_floats() { return static_cast<std::ptrdiff_t>(6 * lane_count()); }

/// The nodes of a row in a column of a pair whose row 0 begins at `column`.
HWY_INLINE NodeLanes nodes_of(const Real* column, std::ptrdiff_t row) {
  const Real* nodes = column + row * row_floats();
  return {load3(nodes), load3(nodes + row_floats() / 2)};
}
/// Writes nodes to a row of such a column.
HWY_INLINE void store_nodes(const NodeLanes& nodes, Real* column, std::ptrdiff_t row) {
  Real* to = column + row * row_floats();
  store3(to, nodes.x);
  store3(to + row_floats() / 2, nodes.v);
}

/// Component of a missing node: far from all nodes, because the length of springs without stiffness to it
/// must not be zero.
constexpr Real far_away = 1e9F;

/// The row with each lane's values taken from the lane before, or after.
HWY_INLINE NodeLanes of_lane_before(const NodeLanes& row, std::size_t bands) {
  return {from_lane_before(row.x, far_away, bands), from_lane_before(row.v, far_away, bands)};
}
HWY_INLINE NodeLanes of_lane_behind(const NodeLanes& row, std::size_t bands) {
  return {from_lane_behind(row.x, far_away, bands), from_lane_behind(row.v, far_away, bands)};
}

/// Writes row -1 of a column of `height` rows.
HWY_INLINE void write_row_above(Real* column, std::ptrdiff_t height, std::size_t bands) {
  store_nodes(of_lane_before(nodes_of(column, height - 1), bands), column, -1);
}

/// Sets of springs that a row can own; bit i is spring i of grid_stencil.
enum SpringSet : unsigned {
  down = 1,
  right = 2,
  right_down = 4,
  right_up = 8,
  down_2 = 16,
  right_2 = 32,
  to_next_column = right | right_down | right_up,
  within_column = down | down_2,
  every_spring = within_column | to_next_column | right_2
};
static_assert(grid_stencil[0].rows == 1 && grid_stencil[0].columns == 0, "down");
static_assert(grid_stencil[1].rows == 0 && grid_stencil[1].columns == 1, "right");
static_assert(grid_stencil[2].rows == 1 && grid_stencil[2].columns == 1, "right_down");
static_assert(grid_stencil[3].rows == -1 && grid_stencil[3].columns == 1, "right_up");
static_assert(grid_stencil[4].rows == 2 && grid_stencil[4].columns == 0, "down_2");
static_assert(grid_stencil[5].rows == 0 && grid_stencil[5].columns == 2, "right_2");

/// The data that the walk reads and writes in a column. Pointers to columns are to row 0.
struct ColumnView {
  const BandRowsOf<Real>* rows;         ///< constants of this column
  Real* here;                           ///< gathered pair, this column; its halo rows may be overwritten
  Real* next;                           ///< the column to the right, likewise
  const Real* next_2;                   ///< the column after that
  std::array<Real*, pair_kinds> pairs;  ///< this column of every stored pair, for the update
  /// [row][x y z][lane] from earlier columns; when a row has been read, the forces on the column after the
  /// next replace it, so more rows fit in the first-level cache.
  Real* forces_here;
  Real* forces_next;
};

/// Parameters of the bands for every row. A copy, like the walk's ColumnView: the compiler must assume that a
/// vector store may change any object in memory, and would reload all of it in every row. On two Zen 5 cores
/// at 500 x 700, copies are 1.04 to 1.16 times as fast.
struct RowConstants {
  Coefficients<Real> coefficients;
  SurroundingsOf<Real> surroundings;
  const Real* values;                  ///< BandRows::values
  const std::uint32_t* offset_of_row;  ///< BandRows::offset_of_row
  std::ptrdiff_t height;               ///< of the bands
  std::size_t bands;                   ///< in a half of the lanes
  HWY_INLINE RowConstants(const BandGridOf<Real>& grid, const ColumnView& column)
      : coefficients(grid.coefficients),
        surroundings(grid.surroundings),
        values(column.rows->values()),
        offset_of_row(column.rows->offset_of_row()),
        height(static_cast<std::ptrdiff_t>(grid.layout.height)),
        bands(grid.layout.bands) {}
  /// The constants of a row (BandRows).
  HWY_INLINE const Real* of_row(std::ptrdiff_t row) const { return values + offset_of_row[row]; }
};

/// The constants of one of the springs that a row's nodes own (RowConstants::of_row).
HWY_INLINE SpringLanes spring_of_row(const Real* of_row, SpringSet spring) {
  const auto number = static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(spring)));
  const Real* of_spring = of_row + number * BandRowsOf<Real>::spring_vectors * lane_count();
  const SpringConstants<Lanes> constants = load_constants(of_spring);
  return {constants, hn::Load(RealTag(), of_spring)};
}

/// Forces on later rows, kept while the walk goes down.
struct Carry {
  Lanes3 below;        ///< on the next row of this column
  Lanes3 below_2;      ///< on the row after that
  Lanes3 right_below;  ///< on the next row of the next column
  /// On the previous row of the next column: complete except for this row's spring to it.
  Lanes3 right_above;
};

HWY_INLINE Carry nothing_carried() { return {zero3(), zero3(), zero3(), zero3()}; }

/// A spring of known length and unknown force. A reciprocal root has a long latency, and a CPU looks about
/// one row ahead, so each spring is begun before the previous one is finished. On Zen 4, one thread: 0.98 of
/// the time at 200 x 200 and 0.99 at 500 x 700.
struct BegunSpring {
  Lanes3 d;  ///< from the other end to this one
  Lanes closing, inverse_length;
};

/// Begins the spring between two nodes.
HWY_INLINE BegunSpring begin_spring(const NodeLanes& node, const NodeLanes& other) {
  const Lanes3 d = node.x - other.x;
  return {d, dot(node.v - other.v, d), inverse_length(dot(d, d))};
}

/// The force on the other end; the owner gets the opposite.
HWY_INLINE Lanes3 force_of(const BegunSpring& begun, const SpringLanes& spring) {
  return spring_pull_at(begun.inverse_length, begun.closing, spring) * begun.d;
}

/// Prefetches the row that the walk reaches a fixed number of rows later. On Zen 5 at 500 x 700, whose state
/// is in the last-level cache: 1.04 to 1.1 times as fast with two threads, up to twice with one.
HWY_INLINE void prefetch_row(const Real* row) {
  constexpr std::ptrdiff_t rows_ahead = 16;  // columns are contiguous: every address is valid
  constexpr std::ptrdiff_t line_floats = 64 / sizeof(Real);
  for (std::ptrdiff_t i = 0; i < row_floats(); i += line_floats)
    hwy::Prefetch(row + rows_ahead * row_floats() + i);
}

/// Forces, on their other ends, of springs that are known before their row is walked.
struct KnownForces {
  unsigned set = 0;  ///< the springs
  Lanes3 down, down_2, right_down;
};

/// Adds the springs of `set` that a row owns. Returns the force on its nodes from springs of this and earlier
/// rows, and with `received` from earlier columns too. `prefetch`: the state is gathered.
template <bool prefetch>
HWY_INLINE Lanes3 pull_row(const RowConstants& constants, const ColumnView& column, const NodeLanes& node,
                           unsigned set, const KnownForces& known, bool received, Carry& carry,
                           std::ptrdiff_t row) {
  const unsigned to_find = set & ~known.set;
  const std::ptrdiff_t force_floats = 3 * static_cast<std::ptrdiff_t>(lane_count());
  const Real* const of_row = constants.of_row(row);

  BegunSpring to_below{}, to_below_2{}, to_right_above{}, to_right{}, to_right_below{}, to_right_2{};
  if ((to_find & down) != 0) to_below = begin_spring(node, nodes_of(column.here, row + 1));
  if ((to_find & down_2) != 0) to_below_2 = begin_spring(node, nodes_of(column.here, row + 2));
  Lanes3 force = carry.below;
  if (received) force = force + load3(column.forces_here + row * force_floats);
  carry.below = carry.below_2;
  if ((set & down) != 0) {
    const Lanes3 pull = (to_find & down) != 0 ? force_of(to_below, spring_of_row(of_row, down)) : known.down;
    force = force - pull;
    carry.below = carry.below + pull;
  }
  if ((set & right_up) != 0) to_right_above = begin_spring(node, nodes_of(column.next, row - 1));
  if ((set & down_2) != 0) {
    carry.below_2 =
        (to_find & down_2) != 0 ? force_of(to_below_2, spring_of_row(of_row, down_2)) : known.down_2;
    force = force - carry.below_2;
  }
  if ((set & right) != 0) to_right = begin_spring(node, nodes_of(column.next, row));
  if ((set & right_up) != 0) {
    const Lanes3 pull = force_of(to_right_above, spring_of_row(of_row, right_up));
    force = force - pull;
    if (row > 0)
      store3(column.forces_next + (row - 1) * force_floats, carry.right_above + pull);
    else
      store3(column.forces_next + constants.height * force_floats, pull);
  }
  if ((to_find & right_down) != 0) to_right_below = begin_spring(node, nodes_of(column.next, row + 1));
  if ((set & right) != 0) {
    const Lanes3 pull = force_of(to_right, spring_of_row(of_row, right));
    force = force - pull;
    carry.right_above = carry.right_below + load3(column.forces_next + row * force_floats) + pull;
  }
  if ((set & right_2) != 0) {
    if constexpr (prefetch) prefetch_row(column.next_2 + row * row_floats());
    to_right_2 = begin_spring(node, nodes_of(column.next_2, row));
  }
  if ((set & right_down) != 0) {
    carry.right_below = (to_find & right_down) != 0
                            ? force_of(to_right_below, spring_of_row(of_row, right_down))
                            : known.right_down;
    force = force - carry.right_below;
  }
  if ((set & right_2) != 0) {
    const Lanes3 pull = force_of(to_right_2, spring_of_row(of_row, right_2));
    force = force - pull;
    store3(column.forces_here + row * force_floats, pull);
  }

  return force;
}

/// Address of the position (slot 0) or velocity (1) of a row's nodes in a pair.
HWY_INLINE Real* stored_at(const ColumnView& column, Pair pair, std::size_t slot, std::ptrdiff_t row) {
  return column.pairs[index(pair)] + row * row_floats() +
         static_cast<std::ptrdiff_t>(slot % 2) * row_floats() / 2;
}

/// One stage at the nodes of a row, once the force on them is complete, without the floor: `lowest` becomes
/// their new height if that is less. Forces are already accelerations.
template <std::size_t method, std::size_t stage>
HWY_INLINE void update_row(const RowConstants& constants, const ColumnView& column, const NodeLanes& node,
                           const Lanes3& force, std::ptrdiff_t row, Lanes& lowest) {
  const Lanes gravity =
      hn::Load(RealTag(), constants.of_row(row) + BandRowsOf<Real>::gravity_vector * lane_count());
  update_stage<method, stage, true>(
      constants.coefficients, node.x, node.v,
      node_acceleration(force, node.v, Lanes(constants.surroundings.viscous_damping), gravity),
      [&](auto slot) MSSIM_INLINE_LAMBDA {
        constexpr std::size_t i = index(decltype(slot)::value);
        return load3(stored_at(
            column, storage_of(integrators[method], static_cast<Pair>(i / 2), Storage::in_place), i, row));
      },
      [&](auto slot, const Lanes3& value) MSSIM_INLINE_LAMBDA {
        constexpr std::size_t i = index(decltype(slot)::value);
        store3(
            stored_at(column, walk_writes_to(integrators[method], stage, static_cast<Pair>(i / 2)), i, row),
            value);
      },
      [&](const Lanes3& x, const Lanes3&) MSSIM_INLINE_LAMBDA { lowest = Lanes(hn::Min(x.y.v, lowest.v)); });
}

/// Applies the floor to a column after a step, if a node is below it: one test per column, because on Zen 4
/// comparisons use the units that multiply, and minima those that add.
template <std::size_t method, std::size_t stage>
HWY_INLINE void touch_floor_in_column(const RowConstants& constants, const ColumnView& column,
                                      const Lanes& lowest) {
  if constexpr (stage + 1 == integrators[method].stage_count) {
    if (HWY_LIKELY(hn::AllFalse(RealTag(),
                                hn::Lt(lowest.v, hn::Set(RealTag(), constants.surroundings.floor_height)))))
      return;
    constexpr Pair next = walk_writes_to(integrators[method], stage, Pair::next);
    for (std::ptrdiff_t row = 0; row < constants.height; ++row) {
      NodeLanes node{load3(stored_at(column, next, 0, row)), load3(stored_at(column, next, 1, row))};
      touch_floor(EveryLane{}, constants.surroundings, node.x, node.v);
      store3(stored_at(column, next, 0, row), node.x);
      store3(stored_at(column, next, 1, row), node.v);
    }
  }
}

/// Forces of springs that cross the end of a band, on its last two rows.
struct EndForces {
  KnownForces last_but_one, last;
};

/// A lane's last rows are the rows above the next lane's band: the forces of springs of `set` across the end
/// are computed once, here, for the rows that own the springs and, one lane further, for the top rows.
template <unsigned set>
HWY_INLINE EndForces forces_across_ends(const RowConstants& constants, const ColumnView& column) {
  const auto force = [&](const NodeLanes& node, const NodeLanes& other, std::ptrdiff_t row,
                         SpringSet spring) MSSIM_INLINE_LAMBDA {
    return force_of(begin_spring(node, other), spring_of_row(constants.of_row(row), spring));
  };
  const auto below_band = [&](const Real* of, std::ptrdiff_t row) MSSIM_INLINE_LAMBDA {
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

/// Adds the springs of `set` of a column, row by row. act(row, node, force): the force on a row's nodes from
/// springs of this and, if `received`, of earlier columns. `prefetch`: as in pull_row.
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
  // The spring from a band's first row up to the right ends at the last row of the lane before.
  if constexpr ((set & right_up) != 0)
    store3(column.forces_next + (height - 1) * force_floats,
           carry.right_above +
               from_lane_behind(load3(column.forces_next + height * force_floats), none, constants.bands));
}

/// A column whose nodes own all springs and are updated: the usual case.
template <std::size_t method, std::size_t stage>
HWY_NOINLINE void walk_inner_column(const BandGridOf<Real>& bands, const ColumnView& view) {
  constexpr bool gathers_state = integrators[method].stages[stage].gather == Pair::state;
  const RowConstants constants(bands, view);
  const ColumnView column = view;
  Lanes lowest(std::numeric_limits<Real>::max());
  walk_rows<every_spring, gathers_state, true>(
      constants, column,
      [&](std::ptrdiff_t row, const NodeLanes& node, const Lanes3& force)
          MSSIM_INLINE_LAMBDA { update_row<method, stage>(constants, column, node, force, row, lowest); });
  touch_floor_in_column<method, stage>(constants, column, lowest);
}

/// A column before the updated ones, whose springs of `set` act on them, in any stage.
template <unsigned set>
HWY_NOINLINE void walk_column_before(const BandGridOf<Real>& bands, const ColumnView& view) {
  const RowConstants constants(bands, view);
  const ColumnView column = view;
  walk_rows<set, false, false>(constants, column,
                               [](std::ptrdiff_t, const NodeLanes&, const Lanes3&) MSSIM_INLINE_LAMBDA {});
}

/// A column at the end of the cloth, without springs beyond it, in any stage: the complete forces on its
/// nodes replace those from earlier columns.
template <unsigned set>
HWY_NOINLINE void pull_last_column(const BandGridOf<Real>& bands, const ColumnView& view) {
  const RowConstants constants(bands, view);
  const ColumnView column = view;
  walk_rows<set, false, true>(
      constants, column, [&](std::ptrdiff_t row, const NodeLanes&, const Lanes3& force) MSSIM_INLINE_LAMBDA {
        store3(column.forces_here + row * static_cast<std::ptrdiff_t>(3 * lane_count()), force);
      });
}

/// A column at the end of the cloth, with less than BandLayout::halo columns after it.
template <std::size_t method, std::size_t stage>
HWY_NOINLINE void walk_last_column(const BandGridOf<Real>& bands, const ColumnView& view,
                                   std::size_t behind) {
  if (behind == 0)
    pull_last_column<within_column>(bands, view);
  else
    pull_last_column<within_column | to_next_column>(bands, view);
  const RowConstants constants(bands, view);
  const ColumnView column = view;
  Lanes lowest(std::numeric_limits<Real>::max());
  for (std::ptrdiff_t row = 0; row < constants.height; ++row)
    update_row<method, stage>(constants, column, nodes_of(column.here, row),
                              load3(column.forces_here + row * static_cast<std::ptrdiff_t>(3 * lane_count())),
                              row, lowest);
  touch_floor_in_column<method, stage>(constants, column, lowest);
}

}  // namespace MSSIM_PRECISION
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
