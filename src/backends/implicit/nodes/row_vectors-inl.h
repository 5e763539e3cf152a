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
#include "backends/layouts/row_lanes-inl.h"
#include "backends/layouts/spring_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// What every vector needs of the cloth. A copy, because a vector's store may change anything that has an
/// address elsewhere, as far as the compiler knows.
struct RowConstants {
  SpringLanes spring[3];
  std::ptrdiff_t pitch;
  HWY_INLINE explicit RowConstants(const NodeRows& nodes)
      : spring{SpringLanes(nodes.springs[structural]), SpringLanes(nodes.springs[shear]),
               SpringLanes(nodes.springs[bending])},
        pitch(static_cast<std::ptrdiff_t>(nodes.layout.pitch)) {}
};

/// The springs of a vector of nodes that lead to the neighbours of one place in the stencil.
template <class Exists>
struct RowSprings {
  const SpringLanes& constants;  ///< divided by the mass of a node
  Exists exists;                 ///< a Mask or EveryLane: where there is such a spring
  std::ptrdiff_t offset, pitch;

  /// A field at the neighbours.
  HWY_INLINE Lanes3 load(const float* field) const { return load_components(field + offset, pitch); }
};

/// A vector of nodes in a row. Edge: some of its springs or nodes do not exist, or some nodes are pinned.
template <bool edge>
struct RowVector {
  const RowConstants& constants;
  std::conditional_t<edge, EdgeVector, InnerVector> place;
  std::conditional_t<edge, Mask, EveryLane> free;  ///< nodes that move
  std::ptrdiff_t offset;                           ///< of the first node's x in a field
  std::size_t number;                              ///< from 0, in the order of the walk over the whole cloth

  /// Springs of each vector, existing or not.
  static constexpr std::size_t springs = node_springs;
  /// The number of its first spring, from 0, in the order of the walk over the whole cloth.
  HWY_INLINE std::size_t first_spring() const { return number * springs; }

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
      const auto exists = place.has(to.rows, to.columns);
      constexpr auto row_components = static_cast<std::ptrdiff_t>(NodeRows::Layout::components);
      act(RowSprings<std::remove_const_t<decltype(exists)>>{
          constants.spring[to.kind], exists, offset + to.rows * row_components * constants.pitch + to.columns,
          constants.pitch});
    };
    [&]<std::size_t... i>(std::index_sequence<i...>) MSSIM_INLINE_LAMBDA {
      (visit(std::integral_constant<std::size_t, i>{}), ...);
    }
    (std::make_index_sequence<node_springs>{});
  }
};

/// Calls act(vector) for all vectors of nodes in a chunk of rows: a RowVector<true> or RowVector<false>.
template <class Act>
HWY_INLINE void for_each_vector(const NodeRows& nodes, NodeChunk chunk, Act&& act) {
  const RowConstants constants(nodes);
  constexpr std::size_t ring = NodeRows::Layout::ring;
  const std::size_t lanes = lane_count(), rows = nodes.layout.rows, columns = nodes.layout.columns;
  const std::size_t row_vectors = (columns + lanes - 1) / lanes;
  for (std::size_t row = chunk.begin; row < chunk.end; ++row) {
    const auto at_edge = [&](std::size_t begin, std::size_t end) HWY_ATTR {
      for (std::size_t column = begin; column < end; column += lanes) {
        const Lanes free = hn::Load(FloatTag(), nodes.free.data() + nodes.plane.offset(row, column));
        act(RowVector<true>{
            constants,
            {static_cast<std::uint32_t>(row), hn::Iota(IndexTag(), static_cast<std::uint32_t>(column)),
             static_cast<std::uint32_t>(rows), static_cast<std::uint32_t>(columns)},
            hn::Ne(free.v, hn::Zero(FloatTag())),
            static_cast<std::ptrdiff_t>(nodes.layout.offset(row, column)),
            row * row_vectors + column / lanes});
      }
    };
    std::size_t begin = 0, end = 0;  // of the columns of vectors inside
    if (row >= ring && row + ring < rows && columns >= nodes.layout.margin + ring && nodes.row_is_free[row]) {
      begin = nodes.layout.margin;
      end = begin + (columns - ring - begin) / lanes * lanes;
    }
    at_edge(0, begin);
    for (std::size_t column = begin; column < end; column += lanes)
      act(RowVector<false>{constants,
                           {},
                           {},
                           static_cast<std::ptrdiff_t>(nodes.layout.offset(row, column)),
                           row * row_vectors + column / lanes});
    at_edge(end, columns);
  }
}

/// Springs of all vectors of the cloth.
inline std::size_t vector_springs(const NodeRows& nodes) {
  const std::size_t lanes = lane_count();
  return nodes.layout.rows * ((nodes.layout.columns + lanes - 1) / lanes) * node_springs;
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
