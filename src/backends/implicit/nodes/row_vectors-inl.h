// The walk over a cloth (node_rows.h), vector of nodes by vector. Compiled once per instruction set, so the
// guard toggles.
#if defined(MSSIM_ROW_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_ROW_VECTORS_INL_H_
#undef MSSIM_ROW_VECTORS_INL_H_
#else
#define MSSIM_ROW_VECTORS_INL_H_
#endif

#include <type_traits>
#include <utility>

#include "backends/implicit/nodes/node_rows.h"
#include "backends/implicit/nodes/slope_lanes-inl.h"
#include "backends/layouts/row_lanes-inl.h"
#include "backends/layouts/spring_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// What every vector needs of the cloth. A copy, because a vector's store may change anything that has an
/// address elsewhere, as far as the compiler knows.
struct WalkedRows {
  SpringLanes spring[3];
  std::ptrdiff_t pitch;
  HWY_INLINE explicit WalkedRows(const NodeRows& nodes)
      : spring{SpringLanes(nodes.springs[structural]), SpringLanes(nodes.springs[shear]),
               SpringLanes(nodes.springs[bending])},
        pitch(static_cast<std::ptrdiff_t>(nodes.layout.pitch)) {}
};

/// The springs of a vector of nodes that lead to the neighbours of one place in the stencil, the i-th of
/// spring_of_node().
template <std::size_t i, class Exists>
struct RowSprings {
  const SpringLanes& constants;  ///< divided by the mass of a node
  Exists exists;                 ///< a Mask or EveryLane: where there is such a spring
  std::ptrdiff_t pitch;
  std::ptrdiff_t there;  ///< offset of the neighbours in a field
  std::ptrdiff_t slope;  ///< offset of what these springs have in a field of slopes

  /// A field at the neighbours.
  HWY_INLINE Lanes3 load(const float* field) const { return load_components(field + there, pitch); }

  /// A spring stands in a field of slopes once, at the node that owns it in grid_stencil.
  HWY_INLINE void store_slope(float* field, const SlopeLanes& spring) const {
    if constexpr (i % 2 == 0) {
      const FloatTag d;
      hn::Store(spring.n.x.v, d, field + slope);
      hn::Store(spring.n.y.v, d, field + slope + pitch);
      hn::Store(spring.n.z.v, d, field + slope + 2 * pitch);
      hn::Store(spring.across.v, d, field + slope + 3 * pitch);
    }
  }
  HWY_INLINE SlopeLanes load_slope(const float* field) const {
    return {load_components(field + slope, pitch), Lanes(hn::LoadU(FloatTag(), field + slope + 3 * pitch))};
  }
};

/// A vector of nodes in a row. Edge: some of its springs or nodes do not exist, or some nodes are pinned.
template <bool edge>
struct RowVector {
  const WalkedRows& constants;
  std::conditional_t<edge, EdgeVector, InnerVector> place;
  std::conditional_t<edge, Mask, EveryLane> free;  ///< nodes that move
  std::ptrdiff_t offset;                           ///< of the first node's x in a field
  std::ptrdiff_t slopes;                           ///< of what belongs to it in a field of slopes
  std::size_t number;                              ///< from 0, in the order of the walk over the whole cloth

  HWY_INLINE Lanes3 load(const float* field) const {
    const FloatTag d;
    const float* const from = field + offset;
    return {hn::Load(d, from), hn::Load(d, from + constants.pitch), hn::Load(d, from + 2 * constants.pitch)};
  }
  HWY_INLINE void store(float* field, const Lanes3& value) const {
    const FloatTag d;
    float* const to = field + offset;
    hn::Store(value.x.v, d, to);
    hn::Store(value.y.v, d, to + constants.pitch);
    hn::Store(value.z.v, d, to + 2 * constants.pitch);
  }
  /// Stores zero where no node moves.
  HWY_INLINE void store_free(float* field, const Lanes3& value) const { store(field, keep(free, value)); }
  /// What sums over nodes are weighted with, in proportion to their masses: here they are the same.
  HWY_INLINE Lanes weighted(Lanes value) const { return value; }

  /// Calls act(springs) for each place in the stencil.
  template <class Act>
  HWY_INLINE void for_each_spring(Act&& act) const {
    const auto visit = [&]<std::size_t i>(std::integral_constant<std::size_t, i>) MSSIM_INLINE_LAMBDA {
      constexpr GridSpring to = spring_of_node(i);
      constexpr std::ptrdiff_t node_numbers = NodeRows::Layout::components,
                               slope_numbers = NodeRows::SlopeLayout::components,
                               first_slope = i / 2 * NodeRows::spring_slopes;
      const auto exists = place.has(to.rows, to.columns);
      const std::ptrdiff_t pitch = constants.pitch;
      // Each spring's slope stands at the end that owns it.
      const std::ptrdiff_t to_owner = i % 2 == 0 ? 0 : to.rows * slope_numbers * pitch + to.columns;
      act(RowSprings<i, std::remove_const_t<decltype(exists)>>{
          constants.spring[to.kind], exists, pitch, offset + to.rows * node_numbers * pitch + to.columns,
          slopes + first_slope * pitch + to_owner});
    };
    [&]<std::size_t... i>(std::index_sequence<i...>) MSSIM_INLINE_LAMBDA {
      (visit(std::integral_constant<std::size_t, i>{}), ...);
    }
    (std::make_index_sequence<node_springs>{});
  }
};

/// The vectors of a cloth, by row and column.
struct RowWalk {
  WalkedRows constants;
  std::ptrdiff_t node_row, slope_row, margin;  ///< floats
  std::size_t rows, columns, row_vectors;

  HWY_INLINE explicit RowWalk(const NodeRows& nodes)
      : constants(nodes),
        node_row(static_cast<std::ptrdiff_t>(nodes.layout.row_floats())),
        slope_row(static_cast<std::ptrdiff_t>(nodes.slope_layout.row_floats())),
        margin(static_cast<std::ptrdiff_t>(nodes.layout.margin)),
        rows(nodes.layout.rows),
        columns(nodes.layout.columns),
        row_vectors(nodes.row_vectors()) {}

  template <bool edge, class Place, class Free>
  HWY_INLINE RowVector<edge> vector(std::size_t row, std::size_t column, Place place, Free free) const {
    const auto r = static_cast<std::ptrdiff_t>(row + NodeRows::Layout::ring);
    const std::ptrdiff_t c = margin + static_cast<std::ptrdiff_t>(column);
    return {constants,
            place,
            free,
            r * node_row + c,
            r * slope_row + c,
            row * row_vectors + column / lane_count()};
  }
  HWY_INLINE RowVector<false> inner_vector(std::size_t row, std::size_t column) const {
    return vector<false>(row, column, InnerVector{}, EveryLane{});
  }
  HWY_INLINE RowVector<true> edge_vector(std::size_t row, std::size_t column, const float* free) const {
    const auto iota = [](std::size_t first)
                          HWY_ATTR { return hn::Iota(IndexTag(), static_cast<std::uint32_t>(first)); };
    return vector<true>(row, column,
                        EdgeVector{static_cast<std::uint32_t>(row), iota(column),
                                   static_cast<std::uint32_t>(rows), static_cast<std::uint32_t>(columns)},
                        hn::Ne(hn::Load(FloatTag(), free), hn::Zero(FloatTag())));
  }
};

/// Calls act(vector) for all vectors of nodes in a chunk of rows: a RowVector<true> or RowVector<false>.
template <class Act>
HWY_INLINE void for_each_vector(const NodeRows& nodes, NodeChunk chunk, Act&& act) {
  const RowWalk walk(nodes);
  constexpr std::size_t ring = NodeRows::Layout::ring;
  for (std::size_t row = chunk.begin; row < chunk.end; ++row) {
    std::size_t begin = 0, end = 0;  // of the columns of vectors inside
    if (row >= ring && row + ring < walk.rows && walk.columns >= nodes.layout.margin + ring &&
        nodes.row_is_free[row]) {
      begin = nodes.layout.margin;
      end = begin + (walk.columns - ring - begin) / lane_count() * lane_count();
    }
    for (std::size_t column = 0; column < walk.columns; column += lane_count())
      if (column >= begin && column < end)
        act(walk.inner_vector(row, column));
      else
        act(walk.edge_vector(row, column, nodes.free.data() + nodes.plane.offset(row, column)));
  }
}

/// Acts as if all nodes and springs existed and no node were pinned: for what is zero where they do not.
template <class Act>
HWY_INLINE void for_each_whole_vector(const NodeRows& nodes, NodeChunk chunk, Act&& act) {
  const RowWalk walk(nodes);
  for (std::size_t row = chunk.begin; row < chunk.end; ++row)
    for (std::size_t column = 0; column < walk.columns; column += lane_count())
      act(walk.inner_vector(row, column));
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
