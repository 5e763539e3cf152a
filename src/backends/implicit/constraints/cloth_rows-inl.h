// What a small step does with the rows of a cloth in quartered rows. Compiled once per instruction set, so
// the guard toggles.
#if defined(MSSIM_CLOTH_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_CLOTH_ROWS_INL_H_
#undef MSSIM_CLOTH_ROWS_INL_H_
#else
#define MSSIM_CLOTH_ROWS_INL_H_
#endif

#include <cstddef>

#include "backends/implicit/constraints/move_lanes-inl.h"
#include "backends/implicit/constraints/quartered_rows.h"
#include "backends/vectors/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// Constants of springs in registers.
struct ComplianceLanes {
  Lanes stiffness, stiffness_rest, damping;
  HWY_INLINE explicit ComplianceLanes(const Compliance<float>& c)
      : stiffness(c.stiffness), stiffness_rest(c.stiffness_rest), damping(c.damping) {}
  HWY_INLINE ComplianceLanes(Mask first, const ComplianceLanes& a, const ComplianceLanes& b)
      : stiffness(select(first, a.stiffness, b.stiffness)),
        stiffness_rest(select(first, a.stiffness_rest, b.stiffness_rest)),
        damping(select(first, a.damping, b.damping)) {}
};

/// Three components of a vector of nodes that need not begin where a vector does.
HWY_INLINE Lanes3 load_part(const float* from, std::size_t pitch) {
  const FloatTag d;
  return {hn::LoadU(d, from), hn::LoadU(d, from + pitch), hn::LoadU(d, from + 2 * pitch)};
}
HWY_INLINE void store_part(EveryLane, const Lanes3& value, float* to, std::size_t pitch) {
  const FloatTag d;
  hn::StoreU(value.x.v, d, to);
  hn::StoreU(value.y.v, d, to + pitch);
  hn::StoreU(value.z.v, d, to + 2 * pitch);
}
HWY_INLINE void store_part(Mask lanes, const Lanes3& value, float* to, std::size_t pitch) {
  const FloatTag d;
  hn::BlendedStore(value.x.v, lanes, d, to);
  hn::BlendedStore(value.y.v, lanes, d, to + pitch);
  hn::BlendedStore(value.z.v, lanes, d, to + 2 * pitch);
}

/// The springs of a vector of `first` and one of `second`: where the x of the nodes begin. The ends that move
/// are those of the lanes given.
template <class FirstLanes, class SecondLanes>
HWY_INLINE void project(float* first, float* second, std::size_t pitch, Lanes h, const ComplianceLanes& c,
                        FirstLanes first_moves, SecondLanes second_moves) {
  const NodeLanes a{load_part(first, pitch), load_part(first + 3 * pitch, pitch)};
  const NodeLanes b{load_part(second, pitch), load_part(second + 3 * pitch, pitch)};
  const Lanes3 u = b.v - a.v, way = mul_add(h, u, b.x - a.x);
  const Lanes pull =
      spring_pull_at(inverse_length(dot(way, way)), dot(u, way), c.stiffness, c.stiffness_rest, c.damping);
  store_part(first_moves, mul_add(pull, way, a.v), first + 3 * pitch, pitch);
  store_part(second_moves, mul_add(-pull, way, b.v), second + 3 * pitch, pitch);
}

/// Springs of a colour: from nodes of a stream, in `rows` rows, each `row_step` rows further, to nodes `down`
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
  const ComplianceLanes c(cloth.of_free[springs.kind]);
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
      const ComplianceLanes of_pinned(cloth.of_pinned[springs.kind]);
      const FloatTag d;
      for (std::size_t at = 0; at < count; at += lanes) {
        const Mask there = below(hn::Iota(IndexTag(), 0), static_cast<std::uint32_t>(count - at));
        const Mask first_moves = hn::And(there, hn::Ne(hn::LoadU(d, first_free + at), hn::Zero(d)));
        const Mask second_moves = hn::And(there, hn::Ne(hn::LoadU(d, second_free + at), hn::Zero(d)));
        project(first + at, second + at, pitch, h,
                ComplianceLanes(hn::And(first_moves, second_moves), c, of_pinned), first_moves, second_moves);
      }
      continue;
    }
    for (std::size_t at = 0; at < whole; at += lanes)
      project(first + at, second + at, pitch, h, c, EveryLane(), EveryLane());
    if (whole < count) project(first + whole, second + whole, pitch, h, c, rest, rest);
  }
}

/// Gravity and the damping of the air in `rows` rows.
HWY_NOINLINE inline void let_fall(QuarteredRows& cloth, std::size_t first_row, std::size_t rows) {
  const FloatTag d;
  const std::size_t pitch = cloth.layout.pitch, nodes = cloth.layout.springs(0, 0);
  const Lanes gravity(cloth.fall), kept(cloth.kept);
  for (std::size_t row = first_row; row < first_row + rows; ++row)
    for (std::size_t stream = 0; stream < QuarterLayout::streams; ++stream) {
      float* const v = cloth.nodes.data() + row * cloth.layout.row_floats() +
                       (stream * QuarterLayout::components + 3) * pitch;
      const float* const free = cloth.free_of_row[row] + stream * pitch;
      for (std::size_t at = 0; at < nodes; at += lane_count()) {
        const Mask moves = hn::Ne(hn::Load(d, free + at), hn::Zero(d));
        store_part(EveryLane(), fallen(moves, load_part(v + at, pitch), gravity, kept), v + at, pitch);
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
/// the row below it.
HWY_INLINE void project_between_rows(QuarteredRows& cloth, std::size_t first_row, std::size_t pairs) {
  for (const std::size_t stream : {0U, 1U, 2U, 3U})
    project_springs(cloth, {first_row, pairs, 2, 1, stream, 0, structural});
  for (const std::size_t stream : {0U, 1U, 2U, 3U})
    project_springs(cloth, {first_row, pairs, 2, 1, stream, 1, shear});
  for (const std::size_t stream : {0U, 1U, 2U, 3U})
    project_springs(cloth, {first_row + 1, pairs, 2, -1, stream, 1, shear});
}

/// The bending springs between each of `rows` rows and the next but one.
HWY_INLINE void project_across_rows(QuarteredRows& cloth, std::size_t first_row, std::size_t rows) {
  for (const std::size_t stream : {0U, 1U, 2U, 3U})
    project_springs(cloth, {first_row, rows, 1, 2, stream, 0, bending});
}

/// The end of a small step, x += h v, and at the end of a step the floor.
HWY_NOINLINE inline void advance(QuarteredRows& cloth, std::size_t first_row, std::size_t rows,
                                 bool meets_floor) {
  const FloatTag d;
  const std::size_t pitch = cloth.layout.pitch, nodes = cloth.layout.springs(0, 0);
  const Lanes h(cloth.h_s);
  for (std::size_t row = first_row; row < first_row + rows; ++row)
    for (std::size_t stream = 0; stream < QuarterLayout::streams; ++stream) {
      float* const x =
          cloth.nodes.data() + row * cloth.layout.row_floats() + stream * QuarterLayout::components * pitch;
      float* const rest = cloth.rest.data() + row * cloth.layout.rest_row_floats() + stream * 3 * pitch;
      for (std::size_t at = 0; at < nodes; at += lane_count()) {
        NodeLanes node{load_part(x + at, pitch), load_part(x + at + 3 * pitch, pitch)};
        Lanes3 lacks = load_part(rest + at, pitch);
        carry_sum(node.x, lacks, h, node.v);  // pins have no velocity
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

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
