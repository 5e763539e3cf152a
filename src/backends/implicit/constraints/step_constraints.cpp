// Substeps of xpbd for vectors of nodes: a cloth pass by pass, bodies colour by colour.
#include "backends/vectors/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/implicit/constraints/step_constraints.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>

#include "backends/implicit/constraints/step_constraints.h"
#include "backends/layouts/records-inl.h"
#include "backends/threads/spin_barrier.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

#include "backends/implicit/constraints/carried_sum-inl.h"

/// Gravity and air damping at nodes that move. `rest`: where those of u, v, w are, at distances of `pitch`.
HWY_INLINE void let_nodes_fall(Mask moves, Lanes3& v, float* rest, std::size_t pitch, Lanes lost,
                               Lanes fall) {
  const Lanes3 lacked = load3(rest, pitch);
  Lanes3 next = v, lacks = lacked;
  carry_fall(next, lacks, lost, fall);
  v = select(moves, next, v);
  store3(rest, select(moves, lacks, lacked), pitch);
}

/// The floor, at the end of a step. A node on it has rest 0, which could otherwise be negative.
HWY_INLINE void meet_floor(Mask moves, const Surroundings& surroundings, NodeLanes& node, Lanes3& rest) {
  touch_floor(moves, surroundings, node.x, node.v);
  rest.y = keep(hn::Gt(node.x.y.v, Lanes(surroundings.floor_height).v), rest.y);
}

HWY_INLINE SpringLanes select(Mask first, const SpringLanes& a, const SpringLanes& b) {
  return HWY_NAMESPACE::spring_from<Lanes>(
      [first](Lanes yes, Lanes no) MSSIM_INLINE_LAMBDA { return select(first, yes, no); }, a, b);
}

/// Three components of a vector of nodes at an unaligned address.
HWY_INLINE void store_part(EveryLane, const Lanes3& value, float* to, std::size_t pitch) {
  const RealTag d;
  hn::StoreU(value.x.v, d, to);
  hn::StoreU(value.y.v, d, to + pitch);
  hn::StoreU(value.z.v, d, to + 2 * pitch);
}
HWY_INLINE void store_part(Mask lanes, const Lanes3& value, float* to, std::size_t pitch) {
  const RealTag d;
  hn::BlendedStore(value.x.v, lanes, d, to);
  hn::BlendedStore(value.y.v, lanes, d, to + pitch);
  hn::BlendedStore(value.z.v, lanes, d, to + 2 * pitch);
}

/// Pull of compliant springs between nodes a and b in a substep of h, per unit of `way`, which becomes the
/// vector from a to b at the substep's end.
HWY_INLINE Lanes pull_between(const NodeLanes& a, const NodeLanes& b, Lanes h, const SpringLanes& c,
                              Lanes3& way) {
  const Lanes3 u = b.v - a.v;
  way = mul_add(h, u, b.x - a.x);
  return spring_pull_at(inverse_length(dot(way, way)), dot(u, way), c);
}

/// The springs between a vector of nodes at `first` and one at `second`, the addresses of their x. Only the
/// ends in the given lanes move.
template <class FirstLanes, class SecondLanes>
HWY_INLINE void project(float* first, float* second, std::size_t pitch, Lanes h, const SpringLanes& c,
                        FirstLanes first_moves, SecondLanes second_moves) {
  const NodeLanes a = load_node(first, pitch), b = load_node(second, pitch);
  Lanes3 way;
  const Lanes pull = pull_between(a, b, h, c, way);
  store_part(first_moves, mul_add(pull, way, a.v), first + 3 * pitch, pitch);
  store_part(second_moves, mul_add(-pull, way, b.v), second + 3 * pitch, pitch);
}

/// Springs of a colour: from nodes of a stream, in `rows` rows at distances of `row_step`, to nodes `down`
/// rows and `right` columns further.
struct Springs {
  std::size_t first_row, rows, row_step;
  std::ptrdiff_t down;
  std::size_t stream, right;
  GridSpringKind kind;
};

HWY_NOINLINE inline void project_springs(QuarteredRows& cloth, const Springs& springs) {
  const QuarterLayout& layout = cloth.layout;
  const std::size_t pitch = layout.pitch, lanes = lane_count();
  const std::size_t count = layout.springs(springs.stream, springs.right), whole = count / lanes * lanes;
  const Mask rest = below(hn::Iota(IndexTag(), 0), static_cast<std::uint32_t>(count - whole));

  const std::size_t target = springs.stream + springs.right;
  const std::size_t other = target % QuarterLayout::streams, further = target / QuarterLayout::streams;
  const Lanes h(cloth.h_s);
  const SpringLanes c = in_every_lane(cloth.of_free[springs.kind]);
  for (std::size_t i = 0; i < springs.rows; ++i) {
    const std::size_t row = springs.first_row + i * springs.row_step;
    const std::size_t other_row = row + static_cast<std::size_t>(springs.down);
    float* const first =
        cloth.nodes.data() + row * layout.row_floats() + springs.stream * QuarterLayout::components * pitch;
    float* const second = cloth.nodes.data() + other_row * layout.row_floats() +
                          other * QuarterLayout::components * pitch + further;
    if (cloth.has_pins(row) || cloth.has_pins(other_row)) {
      const float* const first_free = cloth.free_of_row[row] + springs.stream * pitch;
      const float* const second_free = cloth.free_of_row[other_row] + other * pitch + further;
      const SpringLanes of_pinned = in_every_lane(cloth.of_pinned[springs.kind]);
      const RealTag d;
      for (std::size_t at = 0; at < count; at += lanes) {
        const Mask there = below(hn::Iota(IndexTag(), 0), static_cast<std::uint32_t>(count - at));
        const Mask first_moves = hn::And(there, hn::Ne(hn::LoadU(d, first_free + at), hn::Zero(d)));
        const Mask second_moves = hn::And(there, hn::Ne(hn::LoadU(d, second_free + at), hn::Zero(d)));
        project(first + at, second + at, pitch, h, select(hn::And(first_moves, second_moves), c, of_pinned),
                first_moves, second_moves);
      }
      continue;
    }
    for (std::size_t at = 0; at < whole; at += lanes)
      project(first + at, second + at, pitch, h, c, EveryLane(), EveryLane());
    if (whole < count) project(first + whole, second + whole, pitch, h, c, rest, rest);
  }
}

/// Gravity and air damping in `rows` rows.
HWY_NOINLINE inline void let_fall(QuarteredRows& cloth, std::size_t first_row, std::size_t rows) {
  const RealTag d;
  const std::size_t pitch = cloth.layout.pitch, nodes = cloth.layout.springs(0, 0);
  const Lanes lost(cloth.lost), fall(cloth.fall);
  for (std::size_t row = first_row; row < first_row + rows; ++row)
    for (std::size_t stream = 0; stream < QuarterLayout::streams; ++stream) {
      const std::size_t from =
          row * cloth.layout.row_floats() + (stream * QuarterLayout::components + 3) * pitch;
      float *const velocity = cloth.nodes.data() + from, *const rest = cloth.rest.data() + from;
      const float* const free = cloth.free_of_row[row] + stream * pitch;
      for (std::size_t at = 0; at < nodes; at += lane_count()) {
        const Mask moves = hn::Ne(hn::Load(d, free + at), hn::Zero(d));
        Lanes3 v = load_components(velocity + at, pitch);
        let_nodes_fall(moves, v, rest + at, pitch, lost, fall);
        store_part(EveryLane(), v, velocity + at, pitch);
      }
    }
}

/// The colours along rows.
HWY_INLINE void project_along_rows(QuarteredRows& cloth, std::size_t first_row, std::size_t rows) {
  for (const std::size_t stream : {0U, 2U, 1U, 3U})
    project_springs(cloth, {first_row, rows, 1, 0, stream, 1, structural});
  for (const std::size_t stream : {0U, 1U, 2U, 3U})
    project_springs(cloth, {first_row, rows, 1, 0, stream, 2, bending});
}

/// The structural and shear colours between each of `pairs` rows, every other one from `first_row` on, and
/// the next row.
HWY_INLINE void project_between_rows(QuarteredRows& cloth, std::size_t first_row, std::size_t pairs) {
  for (const std::size_t stream : {0U, 1U, 2U, 3U})
    project_springs(cloth, {first_row, pairs, 2, 1, stream, 0, structural});
  for (const std::size_t stream : {0U, 1U, 2U, 3U})
    project_springs(cloth, {first_row, pairs, 2, 1, stream, 1, shear});
  for (const std::size_t stream : {0U, 1U, 2U, 3U})
    project_springs(cloth, {first_row + 1, pairs, 2, -1, stream, 1, shear});
}

/// The bending springs between each of `rows` rows and the second next.
HWY_INLINE void project_across_rows(QuarteredRows& cloth, std::size_t first_row, std::size_t rows) {
  for (const std::size_t stream : {0U, 1U, 2U, 3U})
    project_springs(cloth, {first_row, rows, 1, 2, stream, 0, bending});
}

/// The end of a substep, x += h v, and at the end of a step the floor.
HWY_NOINLINE inline void advance(QuarteredRows& cloth, std::size_t first_row, std::size_t rows,
                                 bool meets_floor) {
  const RealTag d;
  const std::size_t pitch = cloth.layout.pitch, nodes = cloth.layout.springs(0, 0);
  const Lanes h(cloth.h_s);
  for (std::size_t row = first_row; row < first_row + rows; ++row)
    for (std::size_t stream = 0; stream < QuarterLayout::streams; ++stream) {
      const std::size_t from = row * cloth.layout.row_floats() + stream * QuarterLayout::components * pitch;
      float *const x = cloth.nodes.data() + from, *const rest = cloth.rest.data() + from;
      for (std::size_t at = 0; at < nodes; at += lane_count()) {
        NodeLanes node = load_node(x + at, pitch);
        Lanes3 lacks = load_components(rest + at, pitch);
        carry_move(node.x, lacks, h, node.v);  // pins have zero velocity
        if (meets_floor) {
          meet_floor(hn::Ne(hn::Load(d, cloth.free_of_row[row] + stream * pitch + at), hn::Zero(d)),
                     cloth.surroundings, node, lacks);
          store_part(EveryLane(), node.v, x + at + 3 * pitch, pitch);
        }
        store_part(EveryLane(), node.x, x + at, pitch);
        store_part(EveryLane(), lacks, rest + at, pitch);
      }
    }
}

/// A substep of a cloth by blocks of four rows, in levels that depend on each other:
///
/// own        gravity and damping, springs along its rows, and between rows 0 and 1 and rows 2 and 3,
///     join       springs between the last row of the block before it and its row 0, and rows 1 and 2,
///     bend       bending springs from its rows 0 and 1,
///     bend_join  those from rows 2 and 3 of the block before it,
///     advance    x += h v.
///
/// A level of a block needs the previous level of that block and of one neighbour. So a pass goes down the
/// cloth once, with the levels of several substeps in sequence, each `lag` blocks after the first.
enum class BlockLevel : std::size_t { own, join, bend, bend_join, advance };
constexpr std::size_t block_levels = 5, block_rows = QuarteredRows::block_rows;

/// Number of blocks by which a level of a substep follows the first level of the pass.
constexpr std::size_t lag(std::size_t small_step, BlockLevel level) {
  constexpr std::array<std::size_t, block_levels> behind{0, 0, 1, 1, 2};
  return 2 * small_step + behind[static_cast<std::size_t>(level)];
}

/// A thread's blocks of a cloth of `all` blocks.
struct BlockShare {
  std::size_t begin, end, all;

  BlockShare(const Team& team, std::size_t blocks)
      : begin(team.begin(blocks)), end(team.end(blocks)), all(blocks) {}

  /// Blocks of a level that do not depend on the neighbours' work in this pass: its own, except for some at
  /// each end that is not the cloth's.
  IndexRange alone(std::size_t small_step, BlockLevel level) const {
    constexpr std::array<std::size_t, block_levels> missing_before{0, 1, 1, 2, 2};
    const std::size_t before = 2 * small_step + missing_before[static_cast<std::size_t>(level)];
    return {begin == 0 ? 0 : begin + before, end == all ? all : end - lag(small_step, level)};
  }
};

/// One level of a block of rows. `meets_floor`: the substep is the last of a step.
HWY_INLINE void do_level(QuarteredRows& cloth, BlockLevel level, std::size_t block, bool meets_floor) {
  const std::size_t rows = cloth.layout.rows, first = block * block_rows;
  const std::size_t end = std::min(first + block_rows, rows);
  const auto pairs_from = [&](std::size_t row, std::size_t most) {
    return row + 1 < rows ? std::min(most, (rows - row) / 2) : 0;
  };
  switch (level) {
    case BlockLevel::own:
      let_fall(cloth, first, end - first);
      project_along_rows(cloth, first, end - first);
      project_between_rows(cloth, first, pairs_from(first, 2));
      return;
    case BlockLevel::join:
      if (block > 0)
        project_between_rows(cloth, first - 1, pairs_from(first - 1, 2));
      else
        project_between_rows(cloth, 1, pairs_from(1, 1));
      return;
    case BlockLevel::bend:
      project_across_rows(cloth, first, std::min<std::size_t>(2, rows - std::min(rows, first + 2)));
      return;
    case BlockLevel::bend_join:
      if (block == 0) return;
      project_across_rows(cloth, first - 2, std::min<std::size_t>(2, rows - first));
      return;
    case BlockLevel::advance:
      advance(cloth, first, end - first, meets_floor);
      return;
  }
}

/// Goes down the cloth with all levels of the call's substeps `begin` to `end` - 1, each in range(number of
/// the substep in the pass, level).
template <class Range>
HWY_NOINLINE void walk_down(QuarteredRows& cloth, std::size_t begin, std::size_t end, Range range) {
  std::size_t first = cloth.blocks(), last = 0;
  const auto for_each_level = [&](auto&& act) MSSIM_INLINE_LAMBDA {
    for (std::size_t small = 0; small < end - begin; ++small)
      for (std::size_t level = 0; level < block_levels; ++level) act(small, static_cast<BlockLevel>(level));
  };
  for_each_level([&](std::size_t small, BlockLevel level) HWY_ATTR {
    const IndexRange blocks = range(small, level);
    first = std::min(first, blocks.begin + lag(small, level));
    last = std::max(last, blocks.end + lag(small, level));
  });
  for (std::size_t front = first; front < last; ++front)
    for_each_level([&](std::size_t small, BlockLevel level) HWY_ATTR {
      const IndexRange blocks = range(small, level);
      const std::size_t block = front - lag(small, level);
      if (front < blocks.begin + lag(small, level) || block >= blocks.end) return;
      do_level(cloth, level, block, (begin + small + 1) % cloth.substeps == 0);
    });
}

/// Takes `count` steps.
void step_cloth(QuarteredRows& cloth, int count) {
  // For any division among threads, each spring sees the result of the colours before its own: bitwise
  // identical for any number of threads and of substeps per pass.
  const std::size_t small_steps = static_cast<std::size_t>(count) * cloth.substeps;
  const std::size_t passes = (small_steps + cloth.depth - 1) / cloth.depth;
  const std::size_t blocks = cloth.blocks();
  const auto walk = [&](std::size_t pass, auto&& range) HWY_ATTR {
    walk_down(cloth, pass * cloth.depth, std::min((pass + 1) * cloth.depth, small_steps), range);
  };
  const auto pass_alone = [&](std::size_t pass) HWY_ATTR {
    if (pass >= passes) return false;
    walk(pass, [&](std::size_t, BlockLevel) HWY_ATTR { return IndexRange{0, blocks}; });
    return true;
  };
  const std::size_t begin = cloth.team_gain.take_rounds(pass_alone);
  if (begin == passes) return;
  const auto take_passes = [&](const Team& team) HWY_ATTR {
    const BlockShare own(team, blocks);
    for (std::size_t pass = begin; pass < passes; ++pass) {
      walk(pass, [&](std::size_t small, BlockLevel level) HWY_ATTR { return own.alone(small, level); });
      if (team.threads == 1) continue;
      team.meet();
      if (team.thread + 1 < team.threads) {
        const BlockShare next({team.thread + 1, team.threads, team.barrier}, blocks);
        walk(pass, [&](std::size_t small, BlockLevel level) HWY_ATTR {
          return IndexRange{own.alone(small, level).end, next.alone(small, level).begin};
        });
      }
      pass += team.end_round([&](std::size_t taken) HWY_ATTR { return pass_alone(pass + 1 + taken); });
    }
  };
  with_team(cloth.threads, take_passes, cloth.team_gain);
}

constexpr std::size_t vector_springs = hn::MaxLanes(RealTag());

/// Writes the velocities of the nodes whose records are at record(0), record(1) ..., one per lane, in stores
/// of blocks of four floats. With scatter instructions, one per component, a step of 38,233 and of 3,858
/// nodes takes 1.8 to 2 times as long on Zen 4.
#if HWY_TARGET == HWY_SCALAR
template <class Record>
HWY_INLINE void scatter_velocities(const Lanes3& v, Record record) {
  const RealTag d;
  hn::Store(v.x.v, d, record(0) + 4);
  hn::Store(v.y.v, d, record(0) + 5);
  hn::Store(v.z.v, d, record(0) + 6);
}
#else
template <class Tag, class V, class Record>
HWY_INLINE void store_blocks(Tag d, V blocks, std::size_t first, Record record) {
  if constexpr (hn::MaxLanes(Tag()) == 4) {
    hn::Store(blocks, d, record(first) + 4);
  } else {
    const hn::Half<Tag> half;
    store_blocks(half, hn::LowerHalf(half, blocks), first, record);
    store_blocks(half, hn::UpperHalf(half, blocks), first + hn::MaxLanes(Tag()) / 2, record);
  }
}
template <class Record>
HWY_INLINE void scatter_velocities(const Lanes3& v, Record record) {
  const RealTag d;
  hn::Vec<RealTag> blocks[4];  // block b of number i is that of lane 4 b + i
  transpose_blocks<hn::Vec<RealTag> >(v.x.v, v.y.v, v.z.v, hn::Zero(d), blocks);
  for (std::size_t i = 0; i < 4; ++i) store_blocks(d, blocks[i], i, record);
}
#endif

/// The springs of vectors [begin, end) of a batch.
HWY_INLINE void project_batch(SpringBatches& bodies, const SpringBatches::Batch& batch, std::size_t begin,
                              std::size_t end) {
  const RealTag d;
  float* const nodes = bodies.nodes.data();
  const Lanes h(bodies.h_s);
  SpringLanes spring{in_every_lane(batch.constants), Lanes(0.0F)};
  const Lanes first_mobility(batch.first_mobility), second_mobility(batch.second_mobility);
  const float* const last = bodies.springs.data() + end * 3 * vector_springs;
  for (const float* entry = bodies.springs.data() + begin * 3 * vector_springs; entry < last;
       entry += 3 * vector_springs) {
    const auto first = [&](std::size_t i) MSSIM_INLINE_LAMBDA {
      return nodes + std::size_t{std::bit_cast<std::uint32_t>(entry[i])} * SpringBatches::offset_floats;
    };
    const auto second = [&](std::size_t i) MSSIM_INLINE_LAMBDA {
      return nodes + std::size_t{std::bit_cast<std::uint32_t>(entry[vector_springs + i])} *
                         SpringBatches::offset_floats;
    };
    const NodeLanes a = load_records<vector_springs>(first), b = load_records<vector_springs>(second);
    spring.stiffness_rest = hn::Load(d, entry + 2 * vector_springs);
    Lanes3 way;
    const Lanes pull = pull_between(a, b, h, spring, way);
    scatter_velocities(mul_add(first_mobility * pull, way, a.v), first);
    scatter_velocities(mul_add(-(second_mobility * pull), way, b.v), second);
  }
}

/// Vectors [begin, end) of the springs of a colour.
HWY_NOINLINE inline void project_colour(SpringBatches& bodies, const IndexRange& colour, std::size_t begin,
                                        std::size_t end) {
  const std::size_t first = bodies.batches[colour.begin].begin;
  for (std::size_t i = colour.begin; i < colour.end; ++i) {
    const SpringBatches::Batch& batch = bodies.batches[i];
    project_batch(bodies, batch, std::max(first + begin, batch.begin), std::min(first + end, batch.end));
  }
}

/// The operations on nodes between the springs of one substep and those of the next.
struct Between {
  bool advances;     ///< x += h v; not before the first one
  bool meets_floor;  ///< after that: the substep was the last of a step
  bool falls;        ///< v = (v - h g) / (1 + h c); not after the last one
};

/// Executes them at vectors [begin, end) of nodes.
HWY_NOINLINE inline void move_nodes(SpringBatches& bodies, const Between& between, std::size_t begin,
                                    std::size_t end) {
  const RealTag d;
  const Lanes h(bodies.h_s), lost(bodies.lost), fall(bodies.fall);
  for (std::size_t vector = begin; vector < end; ++vector) {
    float* const records = bodies.nodes.data() + vector * vector_springs * record_floats;
    NodeLanes node = load_records<vector_springs>(
        [&](std::size_t i) MSSIM_INLINE_LAMBDA { return records + i * record_floats; });
    const Mask moves = hn::Ne(hn::Load(d, bodies.free.data() + vector * vector_springs), hn::Zero(d));
    float* const rest = bodies.rest.data() + vector * SpringBatches::rest_components * vector_springs;
    if (between.advances) {
      Lanes3 lacks = load3(rest);
      carry_move(node.x, lacks, h, node.v);  // pins have zero velocity
      if (between.meets_floor) meet_floor(moves, bodies.surroundings, node, lacks);
      store3(rest, lacks);
    }
    if (between.falls) let_nodes_fall(moves, node.v, rest + 3 * vector_springs, vector_springs, lost, fall);
    store_records<vector_springs>(records, node);
  }
}

/// A Team of one thread, without synchronisation.
struct Alone {
  static HWY_INLINE std::size_t begin(std::size_t /*count*/) { return 0; }
  static HWY_INLINE std::size_t end(std::size_t count) { return count; }
  HWY_INLINE void meet() const {}
  template <class TakeRound>
  HWY_INLINE std::size_t end_round(TakeRound&& /*take_round*/) const {
    return 0;
  }
};

/// A thread's share of a substep of a part, up to the last colour, beginning with its nodes.
template <class Threads>
HWY_INLINE void step_colours(SpringBatches& bodies, const SpringBatches::Part& part, std::size_t small,
                             const Threads& team) {
  const std::size_t nodes = part.end - part.begin;
  move_nodes(bodies, {small > 0, small > 0 && small % bodies.substeps == 0, true},
             part.begin + team.begin(nodes), part.begin + team.end(nodes));
  for (std::size_t colour = part.first_colour; colour < part.end_colour; ++colour) {
    const std::size_t springs = bodies.vectors(bodies.colours[colour]);
    team.meet();
    project_colour(bodies, bodies.colours[colour], team.begin(springs), team.end(springs));
  }
}

/// A thread's share of `count` substeps of a part.
template <class Threads>
HWY_INLINE void step_part(SpringBatches& bodies, const SpringBatches::Part& part, std::size_t count,
                          const Threads& team) {
  if (count == 0) return;
  for (std::size_t small = 0; small < count; ++small) {
    step_colours(bodies, part, small, team);
    small += team.end_round([&](std::size_t taken) HWY_ATTR {
      const std::size_t next = small + 1 + taken;
      if (next >= count) return false;
      step_colours(bodies, part, next, Alone());
      return true;
    });
  }
  const std::size_t nodes = part.end - part.begin;
  move_nodes(bodies, {true, true, false}, part.begin + team.begin(nodes), part.begin + team.end(nodes));
}

/// Takes `count` steps.
void step_bodies(SpringBatches& bodies, int count) {
  // The springs of a colour share no node, and parts share nothing: bitwise identical for any number of
  // threads.
  const std::size_t small_steps = static_cast<std::size_t>(count) * bodies.substeps;
  const auto take_parts = [&](const Team& team) HWY_ATTR {
    for (const std::size_t part : bodies.shared_parts)
      step_part(bodies, bodies.parts[part], small_steps, team);
    for (std::size_t owner = team.thread; owner < bodies.own_parts.size(); owner += team.threads)
      for (const std::size_t part : bodies.own_parts[owner])
        step_part(bodies, bodies.parts[part], small_steps, Alone());
  };
  with_team(bodies.threads, take_parts, bodies.team_gain);
}

StepKernel<QuarteredRows> xpbd_cloth_kernel() { return kernel_here(&step_cloth); }
StepKernel<SpringBatches> xpbd_bodies_kernel() { return kernel_here(&step_bodies); }

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
MSSIM_COMPILED_KERNELS(QuarteredRows, xpbd_cloth_kernel)
MSSIM_COMPILED_KERNELS(SpringBatches, xpbd_bodies_kernel)
}  // namespace mssim
#endif
