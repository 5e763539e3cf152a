// The walk over the nodes of a cloth or of bodies (node_vectors.h), vector by vector. Compiled once per
// instruction set, so the guard toggles.
#if defined(MSSIM_NODE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_NODE_VECTORS_INL_H_
#undef MSSIM_NODE_VECTORS_INL_H_
#else
#define MSSIM_NODE_VECTORS_INL_H_
#endif

#include <bit>
#include <type_traits>
#include <utility>

#include "backends/implicit/nodes/node_vectors.h"
#include "backends/layouts/node_lanes-inl.h"
#include "backends/layouts/records-inl.h"
#include "backends/layouts/sliced_graph.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// A spring in a field of slopes, from which kernels/spring_jacobian.h computes its Jacobian.
struct SlopeLanes {
  Lanes3 n;      ///< unit vector along the spring, of either sign; zero if there is no spring
  Lanes across;  ///< as for spring_jacobian_times()
};
template <class Exists>
HWY_INLINE SlopeLanes keep(Exists exists, const SlopeLanes& slope) {
  return {keep(exists, slope.n), keep(exists, slope.across)};
}

/// The springs from a vector of nodes to their neighbours in one place of the stencil, the i-th of
/// spring_of_node().
template <std::size_t i, class Exists>
struct RowSprings {
  const SpringLanes& law;  ///< divided by the mass of a node
  Exists exists;           ///< a Mask or EveryLane: lanes with such a spring
  std::ptrdiff_t pitch;
  std::ptrdiff_t there;  ///< offset of the neighbours in a field
  std::ptrdiff_t slope;  ///< offset of these springs in a field of slopes

  /// A field at the neighbours.
  HWY_INLINE Lanes3 load(const float* field) const { return load_components(field + there, pitch); }

  /// A field of slopes has each spring once, at the node that owns it in grid_stencil.
  HWY_INLINE void store_slope(float* field, const SlopeLanes& spring) const {
    if constexpr (i % 2 == 0) {
      store3(field + slope, spring.n, pitch);
      hn::Store(spring.across.v, RealTag(), field + slope + 3 * pitch);
    }
  }
  HWY_INLINE SlopeLanes load_slope(const float* field) const {
    return {load_components(field + slope, pitch), Lanes(hn::LoadU(RealTag(), field + slope + 3 * pitch))};
  }
};

/// A vector of nodes in a row. Edge: some of its springs or nodes are missing, or some nodes are pinned.
template <bool edge>
struct RowVector {
  const WalkedRows& constants;
  std::conditional_t<edge, EdgeVector, InnerVector> place;
  std::conditional_t<edge, Mask, EveryLane> free;  ///< nodes that move
  std::ptrdiff_t offset;                           ///< of the first node's x in a field
  std::ptrdiff_t slopes;                           ///< its offset in a field of slopes
  std::size_t number;                              ///< from 0, in the order of the walk over the whole cloth

  HWY_INLINE Lanes3 load(const float* field) const { return load3(field + offset, constants.pitch); }
  HWY_INLINE void store(float* field, const Lanes3& value) const {
    store3(field + offset, value, constants.pitch);
  }
  /// The weight of nodes in sums, proportional to their masses: here they are equal.
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
      // Each spring's slope is stored at the end that owns it.
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
      : constants(nodes.springs, nodes.layout.pitch),
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
    const std::size_t number = row * row_vectors + column / lane_count();
    return {constants, place, free, r * node_row + c, r * slope_row + c, number};
  }
  HWY_INLINE RowVector<false> inner_vector(std::size_t row, std::size_t column) const {
    return vector<false>(row, column, InnerVector{}, EveryLane{});
  }
  HWY_INLINE RowVector<true> edge_vector(std::size_t row, std::size_t column, const float* free) const {
    const EdgeVector place{static_cast<std::uint32_t>(row),
                           hn::Iota(IndexTag(), static_cast<std::uint32_t>(column)),
                           static_cast<std::uint32_t>(rows), static_cast<std::uint32_t>(columns)};
    return vector<true>(row, column, place, hn::Ne(hn::Load(RealTag(), free), hn::Zero(RealTag())));
  }
};

/// Calls act(vector) for all vectors of nodes in a chunk of rows: a RowVector<true> or RowVector<false>.
template <class Act>
HWY_INLINE void for_each_vector(const NodeRows& nodes, IndexRange chunk, Act&& act) {
  const RowWalk walk(nodes);
  for (std::size_t row = chunk.begin; row < chunk.end; ++row) {
    const auto inner = nodes.layout.inner_columns(row, lane_count());
    const std::size_t end = nodes.row_is_free[row] ? inner.end : 0;
    for (std::size_t column = 0; column < walk.columns; column += lane_count())
      if (column >= inner.begin && column < end)
        act(walk.inner_vector(row, column));
      else
        act(walk.edge_vector(row, column, nodes.free.data() + nodes.plane.offset(row, column)));
  }
}

/// Like a walk in which all nodes and springs exist and no node is pinned: for data that are zero if not.
template <class Act>
HWY_INLINE void for_each_whole_vector(const NodeRows& nodes, IndexRange chunk, Act&& act) {
  const RowWalk walk(nodes);
  for (std::size_t row = chunk.begin; row < chunk.end; ++row)
    for (std::size_t column = 0; column < walk.columns; column += lane_count())
      act(walk.inner_vector(row, column));
}

constexpr std::size_t slice_lanes = hn::MaxLanes(RealTag());

#if HWY_TARGET == HWY_SCALAR

template <class Record>
HWY_INLINE Lanes3 gather_records(Record record) {
  const float* r = record(0);
  return {Lanes(r[0]), Lanes(r[1]), Lanes(r[2])};
}
HWY_INLINE Lanes3 load_slice(const float* from) { return {Lanes(from[0]), Lanes(from[1]), Lanes(from[2])}; }
HWY_INLINE void store_slice(float* to, const Lanes3& value) {
  const RealTag d;
  hn::Store(value.x.v, d, to);
  hn::Store(value.y.v, d, to + 1);
  hn::Store(value.z.v, d, to + 2);
}

#else

/// Loads the records of four floats at record(lane) of each lane.
template <class Record>
HWY_INLINE Lanes3 gather_records(Record record) {
  const RealTag d;
  using Vector = hn::Vec<RealTag>;
  const hn::CappedTag<float, 4> block;
  const auto load = [&](std::size_t i) MSSIM_INLINE_LAMBDA -> Vector {
    if constexpr (slice_lanes == 4) {
      return hn::Load(d, record(i));
    } else if constexpr (slice_lanes == 8) {
      return hn::Combine(d, hn::Load(block, record(i + 4)), hn::Load(block, record(i)));
    } else {
      const hn::Half<RealTag> half;
      return hn::Combine(d,
                         hn::Combine(half, hn::Load(block, record(i + 12)), hn::Load(block, record(i + 8))),
                         hn::Combine(half, hn::Load(block, record(i + 4)), hn::Load(block, record(i))));
    }
  };
  Vector component[4];
  transpose_blocks<Vector>(load(0), load(1), load(2), load(3), component);
  return {component[0], component[1], component[2]};
}

/// Loads the records of a slice, which begin at `from`.
HWY_INLINE Lanes3 load_slice(const float* from) {
  const RealTag d;
  using Vector = hn::Vec<RealTag>;
  Vector component[4];
  transpose_blocks<Vector>(hn::Load(d, from), hn::Load(d, from + slice_lanes),
                           hn::Load(d, from + 2 * slice_lanes), hn::Load(d, from + 3 * slice_lanes),
                           component);
  return {component[0], component[1], component[2]};
}

HWY_INLINE void store_slice(float* to, const Lanes3& value) {
  const RealTag d;
  using Vector = hn::Vec<RealTag>;
  Vector records[4];
  transpose_blocks<Vector>(value.x.v, value.y.v, value.z.v, hn::Zero(d), records);
  for (std::size_t i = 0; i < 4; ++i) hn::Store(records[i], d, to + i * slice_lanes);
}

#endif

/// One entry of a slice: springs to one neighbour of each of its nodes.
struct SliceSprings {
  SpringLanes law;       ///< divided by the mass of a node
  Mask exists;           ///< lanes with such a spring
  const float* entry;    ///< in NodeSlices::entries
  std::ptrdiff_t slope;  ///< offset of these springs in a field of slopes

  /// A field at the neighbours.
  HWY_INLINE Lanes3 load(const float* field) const {
    return gather_records([&](std::size_t i) MSSIM_INLINE_LAMBDA {
      return field + std::size_t{std::bit_cast<std::uint32_t>(entry[i])} * slice_offset_unit<float>;
    });
  }

  HWY_INLINE void store_slope(float* field, const SlopeLanes& spring) const {
    store3(field + slope, spring.n);
    hn::Store(spring.across.v, RealTag(), field + slope + 3 * slice_lanes);
  }
  HWY_INLINE SlopeLanes load_slope(const float* field) const {
    return {load3(field + slope), Lanes(hn::Load(RealTag(), field + slope + 3 * slice_lanes))};
  }
};

/// A slice of nodes.
struct SliceVector {
  const float *entries, *entries_end;  ///< of NodeSlices, of this slice
  const float* constants;              ///< of NodeSlices, of this slice
  Mask free;                           ///< nodes that move
  std::ptrdiff_t offset;               ///< of the first record in a field
  std::ptrdiff_t slopes;               ///< its offset in a field of slopes
  std::size_t number;                  ///< of the slice

  HWY_INLINE Lanes constant(NodeSlices::Constant which) const {
    return hn::Load(RealTag(), constants + which * slice_lanes);
  }
  HWY_INLINE Lanes3 load(const float* field) const { return load_slice(field + offset); }
  HWY_INLINE void store(float* field, const Lanes3& value) const { store_slice(field + offset, value); }
  /// The weight of nodes in sums, proportional to their masses.
  HWY_INLINE Lanes weighted(Lanes value) const { return constant(NodeSlices::mass) * value; }

  /// Calls act(springs) for each entry.
  template <class Act>
  HWY_INLINE void for_each_spring(Act&& act) const {
    const float* of_slice = constants;
    SpringLanes spring{load_constants(of_slice), Lanes(0.0F)};
    constexpr std::ptrdiff_t slope_floats = 4 * slice_lanes;
    std::ptrdiff_t slope = slopes;
    for (const float* e = entries; e < entries_end; e += 2 * slice_lanes, slope += slope_floats) {
      spring.stiffness_rest = hn::Load(RealTag(), e + slice_lanes);
      act(SliceSprings{spring, hn::Ge(spring.stiffness_rest.v, hn::Zero(RealTag())), e, slope});
    }
  }
};

/// Calls act(vector) for all slices of a chunk.
template <class Act>
HWY_INLINE void for_each_vector(const NodeSlices& nodes, IndexRange chunk, Act&& act) {
  const float *const entries = nodes.entries.data(), *const all_constants = nodes.constants.data();
  const std::uint32_t* const first_entry = nodes.first_entry.data();
  constexpr std::size_t entry_floats = 2 * slice_lanes;
  for (std::size_t slice = chunk.begin; slice < chunk.end; ++slice) {
    const float* const constants = all_constants + slice * NodeSlices::constant_count * slice_lanes;
    const Lanes free = hn::Load(RealTag(), constants + NodeSlices::free * slice_lanes);
    act(SliceVector{entries + first_entry[slice] * entry_floats,
                    entries + first_entry[slice + 1] * entry_floats, constants,
                    hn::Ne(free.v, hn::Zero(RealTag())),
                    static_cast<std::ptrdiff_t>(slice * slice_lanes * NodeSlices::record_floats),
                    static_cast<std::ptrdiff_t>(std::size_t{first_entry[slice]} * 4 * slice_lanes), slice});
  }
}

/// Like a walk in which all nodes and springs exist and no node is pinned: for data that are zero if not.
template <class Act>
HWY_INLINE void for_each_whole_vector(const NodeSlices& nodes, IndexRange chunk, Act&& act) {
  for_each_vector(nodes, chunk, act);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
