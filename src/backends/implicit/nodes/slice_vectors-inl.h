// The walk over bodies (node_slices.h), slice by slice; what row_vectors-inl.h is for cloths. Compiled once
// per instruction set, so the guard toggles.
#if defined(MSSIM_SLICE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_SLICE_VECTORS_INL_H_
#undef MSSIM_SLICE_VECTORS_INL_H_
#else
#define MSSIM_SLICE_VECTORS_INL_H_
#endif

#include <bit>

#include "backends/implicit/nodes/node_slices.h"
#include "backends/implicit/nodes/slope_lanes-inl.h"
#include "backends/layouts/records-inl.h"
#include "backends/layouts/slice_entries.h"
#include "backends/layouts/spring_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

constexpr std::size_t slice_lanes = hn::MaxLanes(FloatTag());

#if HWY_TARGET == HWY_SCALAR

template <class Record>
HWY_INLINE Lanes3 gather_records(Record record) {
  const float* r = record(0);
  return {Lanes(r[0]), Lanes(r[1]), Lanes(r[2])};
}
HWY_INLINE Lanes3 load_slice(const float* from) { return {Lanes(from[0]), Lanes(from[1]), Lanes(from[2])}; }
HWY_INLINE void store_slice(float* to, const Lanes3& value) {
  const FloatTag d;
  hn::Store(value.x.v, d, to);
  hn::Store(value.y.v, d, to + 1);
  hn::Store(value.z.v, d, to + 2);
}

#else

/// The records of four floats at record(lane) of each lane.
template <class Record>
HWY_INLINE Lanes3 gather_records(Record record) {
  const FloatTag d;
  using Vector = hn::Vec<FloatTag>;
  const hn::CappedTag<float, 4> block;
  const auto load = [&](std::size_t i) MSSIM_INLINE_LAMBDA -> Vector {
    if constexpr (slice_lanes == 4) {
      return hn::Load(d, record(i));
    } else if constexpr (slice_lanes == 8) {
      return hn::Combine(d, hn::Load(block, record(i + 4)), hn::Load(block, record(i)));
    } else {
      const hn::Half<FloatTag> half;
      return hn::Combine(d,
                         hn::Combine(half, hn::Load(block, record(i + 12)), hn::Load(block, record(i + 8))),
                         hn::Combine(half, hn::Load(block, record(i + 4)), hn::Load(block, record(i))));
    }
  };
  Vector component[4];
  transpose_blocks<Vector>(load(0), load(1), load(2), load(3), component);
  return {component[0], component[1], component[2]};
}

/// The records of a slice, which begin at `from`.
HWY_INLINE Lanes3 load_slice(const float* from) {
  const FloatTag d;
  using Vector = hn::Vec<FloatTag>;
  Vector component[4];
  transpose_blocks<Vector>(hn::Load(d, from), hn::Load(d, from + slice_lanes),
                           hn::Load(d, from + 2 * slice_lanes), hn::Load(d, from + 3 * slice_lanes),
                           component);
  return {component[0], component[1], component[2]};
}

HWY_INLINE void store_slice(float* to, const Lanes3& value) {
  const FloatTag d;
  using Vector = hn::Vec<FloatTag>;
  Vector records[4];
  transpose_blocks<Vector>(value.x.v, value.y.v, value.z.v, hn::Zero(d), records);
  for (std::size_t i = 0; i < 4; ++i) hn::Store(records[i], d, to + i * slice_lanes);
}

#endif

/// One entry of a slice: springs to one neighbour of each of its nodes.
struct SliceSprings {
  SpringLanes constants;  ///< divided by the mass of a node
  Mask exists;            ///< where there is such a spring
  const float* entry;     ///< in NodeSlices::entries
  std::ptrdiff_t slope;   ///< offset of what these springs have in a field of slopes

  /// A field at the neighbours.
  HWY_INLINE Lanes3 load(const float* field) const {
    return gather_records([&](std::size_t i) MSSIM_INLINE_LAMBDA {
      return field + std::size_t{std::bit_cast<std::uint32_t>(entry[i])} * slice_offset_floats;
    });
  }

  HWY_INLINE void store_slope(float* field, const SlopeLanes& spring) const {
    store3(field + slope, spring.n);
    hn::Store(spring.across.v, FloatTag(), field + slope + 3 * slice_lanes);
  }
  HWY_INLINE SlopeLanes load_slope(const float* field) const {
    return {load3(field + slope), Lanes(hn::Load(FloatTag(), field + slope + 3 * slice_lanes))};
  }
};

/// A slice of nodes.
struct SliceVector {
  const float *entries, *entries_end;  ///< of NodeSlices, of this slice
  const float* constants;              ///< of NodeSlices, of this slice
  Mask free;                           ///< nodes that move
  std::ptrdiff_t offset;               ///< of the first record in a field
  std::ptrdiff_t slopes;               ///< of what belongs to it in a field of slopes
  std::size_t number;                  ///< of the slice

  HWY_INLINE Lanes constant(NodeSlices::Constant which) const {
    return hn::Load(FloatTag(), constants + which * slice_lanes);
  }
  HWY_INLINE Lanes3 load(const float* field) const { return load_slice(field + offset); }
  HWY_INLINE void store(float* field, const Lanes3& value) const { store_slice(field + offset, value); }
  /// Stores zero where no node moves.
  HWY_INLINE void store_free(float* field, const Lanes3& value) const { store(field, keep(free, value)); }
  /// What sums over nodes are weighted with, in proportion to their masses.
  HWY_INLINE Lanes weighted(Lanes value) const { return constant(NodeSlices::mass) * value; }

  /// Calls act(springs) for each entry.
  template <class Act>
  HWY_INLINE void for_each_spring(Act&& act) const {
    SpringLanes spring(constant(NodeSlices::stiffness), Lanes(0.0F), constant(NodeSlices::damping));
    constexpr std::ptrdiff_t slope_floats = 4 * slice_lanes;
    std::ptrdiff_t slope = slopes;
    for (const float* e = entries; e < entries_end; e += 2 * slice_lanes, slope += slope_floats) {
      spring.stiffness_rest = hn::Load(FloatTag(), e + slice_lanes);
      act(SliceSprings{spring, hn::Ge(spring.stiffness_rest.v, hn::Zero(FloatTag())), e, slope});
    }
  }
};

/// Calls act(vector) for all slices of a chunk.
template <class Act>
HWY_INLINE void for_each_vector(const NodeSlices& nodes, NodeChunk chunk, Act&& act) {
  const float *const entries = nodes.entries.data(), *const all_constants = nodes.constants.data();
  const std::uint32_t* const first_entry = nodes.first_entry.data();
  constexpr std::size_t entry_floats = 2 * slice_lanes;
  for (std::size_t slice = chunk.begin; slice < chunk.end; ++slice) {
    const float* const constants = all_constants + slice * NodeSlices::constant_count * slice_lanes;
    const Lanes free = hn::Load(FloatTag(), constants + NodeSlices::free * slice_lanes);
    act(SliceVector{entries + first_entry[slice] * entry_floats,
                    entries + first_entry[slice + 1] * entry_floats, constants,
                    hn::Ne(free.v, hn::Zero(FloatTag())),
                    static_cast<std::ptrdiff_t>(slice * slice_lanes * NodeSlices::record_floats),
                    static_cast<std::ptrdiff_t>(std::size_t{first_entry[slice]} * 4 * slice_lanes), slice});
  }
}

/// Acts as if all nodes and springs existed and no node were pinned: for what is zero where they do not.
template <class Act>
HWY_INLINE void for_each_whole_vector(const NodeSlices& nodes, NodeChunk chunk, Act&& act) {
  for_each_vector(nodes, chunk, act);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
