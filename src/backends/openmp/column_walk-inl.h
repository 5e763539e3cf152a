// The walk down one column of a banded cloth: every spring once, every node updated as soon as its forces are
// complete. Compiled once per instruction set, so the guard toggles.
//
// A spring belongs to its upper or left end (grid_stencil). Its force on the other end waits: in registers
// for the rows below, in three columns of forces (this one, the next, the one after) for the columns to the
// right. Walking the columns from left to right and each from the top, a node meets its own springs last;
// nothing conflicts, and nothing behind the walk is read again, so the update may write over the state it was
// computed from.
#if defined(MSSIM_COLUMN_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_COLUMN_WALK_INL_H_
#undef MSSIM_COLUMN_WALK_INL_H_
#else
#define MSSIM_COLUMN_WALK_INL_H_
#endif

#include <hwy/cache_control.h>

#include "backends/layouts/band_grid.h"
#include "backends/vectors/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

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

/// The stored pair that a stage writes `pair` to. Whatever a step gathered its `next` in, its last stage
/// writes it over the state, which no later stage of the step looks at.
template <std::size_t method, std::size_t stage>
constexpr Pair written_to(Pair pair) {
  constexpr const Integrator& integrator = integrators[method];
  if (pair == Pair::next && stage + 1 == integrator.stage_count) return Pair::state;
  return storage_of(integrator, pair, Storage::in_place);
}

/// Where the walk reads and writes. Pointers to columns stand at row 0.
struct ColumnView {
  const float* here;                     ///< gathered pair, this column
  const float* next;                     ///< the column to the right
  const float* next_2;                   ///< the one after
  std::array<float*, pair_kinds> pairs;  ///< this column of every pair that is stored, for the update
  const float* forces_here;              ///< [row][x y z][lane] from columns already walked
  float* forces_next;
  float* forces_next_2;
};

/// Spring constants in registers.
struct SpringLanes {
  Lanes stiffness, stiffness_rest, damping;
  HWY_INLINE explicit SpringLanes(const SpringConstants& s)
      : stiffness(s.stiffness), stiffness_rest(s.stiffness_rest), damping(s.damping) {}
};

/// What every row needs of the bands. A copy, as the walk's ColumnView is: a vector's store may change
/// anything that has an address elsewhere, as far as the compiler knows, which then reads all of it again in
/// every row. Measured on two Zen 5 cores at 500 x 700: copies 1.04 to 1.16 times as fast.
struct RowConstants {
  std::array<SpringLanes, 3> spring;
  Coefficients<float> coefficients;
  Surroundings surroundings;
  std::uint32_t rows;  ///< of the cloth
  Index band_start;    ///< row of the cloth at row 0 of each lane
  HWY_INLINE explicit RowConstants(const BandGrid& bands)
      : spring{SpringLanes(bands.springs[structural]), SpringLanes(bands.springs[shear]),
               SpringLanes(bands.springs[bending])},
        coefficients(bands.coefficients),
        surroundings(bands.surroundings),
        rows(static_cast<std::uint32_t>(bands.layout.rows)),
        band_start(hn::Mul(hn::Iota(IndexTag(), 0),
                           hn::Set(IndexTag(), static_cast<std::uint32_t>(bands.layout.height)))) {}
};

/// Forces that wait for the rows below while the walk goes down.
struct Carry {
  Lanes3 below;        ///< on the next row of this column
  Lanes3 below_2;      ///< on the row after that
  Lanes3 right_below;  ///< on the next row of the next column
  /// On the previous row of the next column: complete but for this row's spring to it.
  Lanes3 right_above;
};

/// A spring's force on its other end; its owner gets the opposite one. `exists`: the lanes that have the
/// spring; looked at only if `masked`, because no force on a dummy matters.
template <bool masked>
HWY_INLINE Lanes3 spring_force(const NodeLanes& node, const float* other, const SpringLanes& spring,
                               Mask exists) {
  // From the other end to this one: what is subtracted can come straight from memory.
  const Lanes3 d = node.x - load3(other);
  const Lanes3 u = node.v - load3(other + 3 * lane_count());
  Lanes factor = spring_pull(dot(d, d), dot(u, d), spring.stiffness, spring.stiffness_rest, spring.damping);
  if constexpr (masked) factor = keep(exists, factor);
  return factor * d;
}

/// Asks for the row of a column of states that the walk comes to next but so many. Measured on Zen 5 at 500 x
/// 700, whose state lies in the last-level cache: 1.04 to 1.1 times as fast with two threads, up to twice
/// with one.
HWY_INLINE void prefetch_row(const float* row) {
  constexpr std::ptrdiff_t rows_ahead = 16;  // behind a column's end lies the next one; no address is wrong
  const std::ptrdiff_t lanes = static_cast<std::ptrdiff_t>(lane_count());
  for (std::ptrdiff_t component = 0; component < 6; ++component)
    hwy::Prefetch(row + (6 * rows_ahead + component) * lanes);
}

/// One row: the springs of `set` that it owns and, if `update`, the nodes' new values.
template <std::size_t method, std::size_t stage>
HWY_INLINE void walk_row(const RowConstants& constants, const ColumnView& column, unsigned set, bool update,
                         Carry& carry, std::ptrdiff_t row) {
  const std::ptrdiff_t lanes = static_cast<std::ptrdiff_t>(lane_count());
  const std::ptrdiff_t row_floats = 6 * lanes, force_floats = 3 * lanes;
  const auto& spring = constants.spring;
  const std::uint32_t rows = constants.rows;
  const NodeLanes node{load3(column.here + row * row_floats),
                       load3(column.here + row * row_floats + 3 * lanes)};
  // Row of the cloth in each lane; a halo row above the cloth wraps to a huge number, which is below no
  // limit.
  const Index cloth_row = hn::Add(constants.band_start, hn::Set(IndexTag(), static_cast<std::uint32_t>(row)));
  const Mask has_below = below(cloth_row, rows - 1);

  Lanes3 force = carry.below;
  if (update) force = force + load3(column.forces_here + row * force_floats);
  carry.below = carry.below_2;
  if ((set & down) != 0) {
    const Lanes3 pull =
        spring_force<true>(node, column.here + (row + 1) * row_floats, spring[structural], has_below);
    force = force - pull;
    carry.below = carry.below + pull;
  }
  if ((set & down_2) != 0) {
    carry.below_2 = spring_force<true>(node, column.here + (row + 2) * row_floats, spring[bending],
                                       below(cloth_row, rows < 2 ? 0 : rows - 2));
    force = force - carry.below_2;
  }
  if ((set & right_up) != 0) {
    const Mask has_above = below(hn::Sub(cloth_row, hn::Set(IndexTag(), 1)), rows - 1);
    const Lanes3 pull =
        spring_force<true>(node, column.next + (row - 1) * row_floats, spring[shear], has_above);
    force = force - pull;
    if (row > 0) store3(column.forces_next + (row - 1) * force_floats, carry.right_above + pull);
  }
  if ((set & right) != 0) {
    const Lanes3 pull =
        spring_force<false>(node, column.next + row * row_floats, spring[structural], has_below);
    force = force - pull;
    carry.right_above = carry.right_below + load3(column.forces_next + row * force_floats) + pull;
  }
  if ((set & right_down) != 0) {
    carry.right_below =
        spring_force<true>(node, column.next + (row + 1) * row_floats, spring[shear], has_below);
    force = force - carry.right_below;
  }
  if ((set & right_2) != 0) {
    const float* other = column.next_2 + row * row_floats;
    if constexpr (integrators[method].stages[stage].gather == Pair::state) prefetch_row(other);
    const Lanes3 pull = spring_force<false>(node, other, spring[bending], has_below);
    force = force - pull;
    store3(column.forces_next_2 + row * force_floats, pull);
  }

  if (update) {
    const Surroundings& surroundings = constants.surroundings;
    // The forces are accelerations already; dummies get none and stay where they are.
    const Lanes3 a = keep(
        below(cloth_row, rows),
        node_acceleration(force, node.v, Lanes(surroundings.viscous_damping), Lanes(surroundings.gravity)));
    const auto address = [&](Pair pair, std::size_t slot) MSSIM_INLINE_LAMBDA {
      return column.pairs[index(pair)] + row * row_floats + static_cast<std::ptrdiff_t>(slot % 2) * 3 * lanes;
    };
    update_stage<method, stage>(
        constants.coefficients, node.x, node.v, a,
        [&](auto slot) MSSIM_INLINE_LAMBDA {
          constexpr std::size_t i = index(decltype(slot)::value);
          return load3(
              address(storage_of(integrators[method], static_cast<Pair>(i / 2), Storage::in_place), i));
        },
        [&](auto slot, const Lanes3& value) MSSIM_INLINE_LAMBDA {
          constexpr std::size_t i = index(decltype(slot)::value);
          store3(address(written_to<method, stage>(static_cast<Pair>(i / 2)), i), value);
        },
        [&](Lanes3& x, Lanes3& v) MSSIM_INLINE_LAMBDA {
          const Lanes height(surroundings.floor_height);
          touch_floor(hn::Lt(x.y.v, height.v), height, Lanes(surroundings.restitution),
                      Lanes(surroundings.friction), x, v);
        });
  }
}

/// One column from the halo rows above it to the one below. `set`: springs of its nodes that exist and
/// matter.
template <std::size_t method, std::size_t stage>
HWY_INLINE void walk_rows(const BandGrid& bands, const ColumnView& view, unsigned set, bool update) {
  const RowConstants constants(bands);
  const ColumnView column = view;
  const auto height = static_cast<std::ptrdiff_t>(bands.layout.height);
  Carry carry{zero3(), zero3(), zero3(), zero3()};
  if ((set & within_column) != 0) walk_row<method, stage>(constants, column, set & down_2, false, carry, -2);
  walk_row<method, stage>(constants, column, set & (within_column | right_down), false, carry, -1);
  for (std::ptrdiff_t row = 0; row < height; ++row)
    walk_row<method, stage>(constants, column, set, update, carry, row);
  if ((set & right_up) != 0) walk_row<method, stage>(constants, column, right_up, false, carry, height);
}

/// A column whose nodes own all springs and are updated: all but a few.
template <std::size_t method, std::size_t stage>
HWY_NOINLINE void walk_inner_column(const BandGrid& bands, const ColumnView& view) {
  walk_rows<method, stage>(bands, view, every_spring, true);
}

/// A column near the end of the cloth or of the partition. It asks in every row what there is to do: code of
/// their own for the four kinds of such columns would take as long again to compile, for a few columns a
/// pass.
template <std::size_t method, std::size_t stage>
HWY_NOINLINE void walk_edge_column(const BandGrid& bands, const ColumnView& view, unsigned set, bool update) {
  walk_rows<method, stage>(bands, view, set, update);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
