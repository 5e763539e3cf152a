// Conversion between nodes as records (node_arrays.h) and vectors of components, transposed in registers, and
// the stages on them. Compiled once per instruction set, so the guard toggles.
#if defined(MSSIM_RECORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_RECORDS_INL_H_
#undef MSSIM_RECORDS_INL_H_
#else
#define MSSIM_RECORDS_INL_H_
#endif

#include <array>
#include <type_traits>
#include <utility>

#include "backends/layouts/node_arrays.h"
#include "backends/layouts/node_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
inline namespace MSSIM_PRECISION {

#if HWY_TARGET == HWY_SCALAR

/// A record of eight numbers.
struct SingleRecord {
  const Real* numbers;
  template <class Record>
  HWY_INLINE explicit SingleRecord(Record record) : numbers(record(0)) {}
  /// Number i of the first four, and of the last four.
  HWY_INLINE Lanes first(std::size_t i) const { return numbers[i]; }
  HWY_INLINE Lanes last(std::size_t i) const { return numbers[4 + i]; }
};
template <std::size_t lanes>
using TransposedRecords = SingleRecord;

/// Writes `lanes` contiguous records at `to`.
template <std::size_t lanes>
HWY_INLINE void store_records(Real* to, const NodeLanes& node) {
  static_assert(lanes == 1);
  const RealTag d;
  hn::Store(node.x.x.v, d, to);
  hn::Store(node.x.y.v, d, to + 1);
  hn::Store(node.x.z.v, d, to + 2);
  hn::Store(node.v.x.v, d, to + 4);
  hn::Store(node.v.y.v, d, to + 5);
  hn::Store(node.v.z.v, d, to + 6);
}

#else

/// For floats only: transposes each block of four, from four vectors of records to their components, or back.
template <class V>
HWY_INLINE void transpose_blocks(V r0, V r1, V r2, V r3, V* out) {
  const hn::DFromV<V> d;
  const hn::RepartitionToWide<hn::DFromV<V> > wide;
  const auto low_01 = hn::BitCast(wide, hn::InterleaveLower(d, r0, r1));
  const auto low_23 = hn::BitCast(wide, hn::InterleaveLower(d, r2, r3));
  const auto high_01 = hn::BitCast(wide, hn::InterleaveUpper(d, r0, r1));
  const auto high_23 = hn::BitCast(wide, hn::InterleaveUpper(d, r2, r3));
  out[0] = hn::BitCast(d, hn::InterleaveLower(wide, low_01, low_23));
  out[1] = hn::BitCast(d, hn::InterleaveUpper(wide, low_01, low_23));
  out[2] = hn::BitCast(d, hn::InterleaveLower(wide, high_01, high_23));
  out[3] = hn::BitCast(d, hn::InterleaveUpper(wide, high_01, high_23));
}

/// The even blocks of four floats of `low`, then those of `high`.
template <class V>
HWY_INLINE V even_blocks(V low, V high) {
#if HWY_CAP_GE512
  // vshuff32x4, which has no name in Highway; its intrinsic causes a false warning of g++ 12.
  return V{
      __builtin_shufflevector(low.raw, high.raw, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27)};
#else
  return hn::ConcatLowerLower(hn::DFromV<V>(), high, low);
#endif
}

/// The odd blocks of four floats of `low`, then those of `high`.
template <class V>
HWY_INLINE V odd_blocks(V low, V high) {
#if HWY_CAP_GE512
  return V{
      __builtin_shufflevector(low.raw, high.raw, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31)};
#else
  return hn::ConcatUpperUpper(hn::DFromV<V>(), high, low);
#endif
}

/// Two vectors of `lanes` doubles.
template <std::size_t lanes>
struct TwoVectors {
  hn::Vec<hn::FixedTag<Real, lanes> > first, second;
};

/// Doubles `at` and `at + 1` of `lanes` records from record(begin) on.
template <std::size_t lanes, class Record>
HWY_INLINE TwoVectors<lanes> load_two(Record record, std::size_t begin, std::size_t at) {
  const hn::FixedTag<Real, lanes> d;
  if constexpr (lanes == 2) {
    const auto a = hn::Load(d, record(begin) + at), b = hn::Load(d, record(begin + 1) + at);
    return {hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b)};
  } else {
    const TwoVectors<lanes / 2> low = load_two<lanes / 2>(record, begin, at);
    const TwoVectors<lanes / 2> high = load_two<lanes / 2>(record, begin + lanes / 2, at);
    return {hn::Combine(d, high.first, low.first), hn::Combine(d, high.second, low.second)};
  }
}

/// Stores them in contiguous records, the first of them at `to`.
template <std::size_t lanes>
HWY_INLINE void store_two(Real* to, const TwoVectors<lanes>& two) {
  const hn::FixedTag<Real, lanes> d;
  if constexpr (lanes == 2) {
    hn::Store(hn::InterleaveLower(d, two.first, two.second), d, to);
    hn::Store(hn::InterleaveUpper(d, two.first, two.second), d, to + 8);
  } else {
    const hn::FixedTag<Real, lanes / 2> half;
    store_two<lanes / 2>(to, {hn::LowerHalf(half, two.first), hn::LowerHalf(half, two.second)});
    store_two<lanes / 2>(to + 8 * lanes / 2,
                         {hn::UpperHalf(half, two.first), hn::UpperHalf(half, two.second)});
  }
}

/// Records of eight doubles, one per lane, transposed.
template <std::size_t lanes>
struct TransposedDoubles {
  TwoVectors<lanes> xy, z, uv, w;

  template <class Record>
  HWY_INLINE explicit TransposedDoubles(Record record)
      : xy(load_two<lanes>(record, 0, 0)),
        z(load_two<lanes>(record, 0, 2)),
        uv(load_two<lanes>(record, 0, 4)),
        w(load_two<lanes>(record, 0, 6)) {}
  HWY_INLINE Lanes first(std::size_t i) const { return i == 0 ? xy.first : i == 1 ? xy.second : z.first; }
  HWY_INLINE Lanes last(std::size_t i) const { return i == 0 ? uv.first : i == 1 ? uv.second : w.first; }
};

/// Records of eight floats, one per lane, transposed except for an exchange of blocks of four floats.
template <std::size_t lanes>
struct TransposedFloats {
  static_assert(lanes == 4 || lanes == 8 || lanes == 16);
  using Vector = hn::Vec<RealTag>;
  /// With 4 lanes: the components of the first and of the last four floats. With more lanes: blocks of both
  /// alternate, for the first and the second half of the records.
  Vector low[4], high[4];

  template <class Record>
  HWY_INLINE explicit TransposedFloats(Record record) {
    const RealTag d;
    if constexpr (lanes == 4) {
      transpose_blocks<Vector>(hn::Load(d, record(0)), hn::Load(d, record(1)), hn::Load(d, record(2)),
                               hn::Load(d, record(3)), low);
      transpose_blocks<Vector>(hn::Load(d, record(0) + 4), hn::Load(d, record(1) + 4),
                               hn::Load(d, record(2) + 4), hn::Load(d, record(3) + 4), high);
    } else {
      // Record i, with 16 lanes followed by record i + 4.
      const auto load = [&](std::size_t i) MSSIM_INLINE_LAMBDA -> Vector {
        if constexpr (lanes == 16) {
          const hn::Half<RealTag> half;
          return hn::Combine(d, hn::Load(half, record(i + 4)), hn::Load(half, record(i)));
        } else {
          return hn::Load(d, record(i));
        }
      };
      constexpr std::size_t middle = lanes / 2;
      transpose_blocks<Vector>(load(0), load(1), load(2), load(3), low);
      transpose_blocks<Vector>(load(middle), load(middle + 1), load(middle + 2), load(middle + 3), high);
    }
  }
  /// Float i of the first four of each record, and of the last four.
  HWY_INLINE Lanes first(std::size_t i) const {
    if constexpr (lanes == 4) return low[i];
    return even_blocks(low[i], high[i]);
  }
  HWY_INLINE Lanes last(std::size_t i) const {
    if constexpr (lanes == 4) return high[i];
    return odd_blocks(low[i], high[i]);
  }
};

template <std::size_t lanes>
using TransposedRecords =
    std::conditional_t<std::is_same_v<Real, float>, TransposedFloats<lanes>, TransposedDoubles<lanes> >;

/// Stores the nodes of a vector as contiguous records.
template <std::size_t lanes>
HWY_INLINE void store_records(Real* to, const NodeLanes& node) {
  const RealTag d;
  using Vector = hn::Vec<RealTag>;
  const Vector zero = hn::Zero(d);
  if constexpr (!std::is_same_v<Real, float>) {
    store_two<lanes>(to, {node.x.x.v, node.x.y.v});
    store_two<lanes>(to + 2, {node.x.z.v, zero});
    store_two<lanes>(to + 4, {node.v.x.v, node.v.y.v});
    store_two<lanes>(to + 6, {node.v.z.v, zero});
  } else if constexpr (lanes == 4) {
    Vector x[4], v[4];
    transpose_blocks<Vector>(node.x.x.v, node.x.y.v, node.x.z.v, zero, x);
    transpose_blocks<Vector>(node.v.x.v, node.v.y.v, node.v.z.v, zero, v);
    for (std::size_t i = 0; i < lanes; ++i) {
      hn::Store(x[i], d, to + 8 * i);
      hn::Store(v[i], d, to + 8 * i + 4);
    }
  } else {
    const auto low = [&](Lanes x, Lanes v)
                         MSSIM_INLINE_LAMBDA { return hn::OddEvenBlocks(hn::SwapAdjacentBlocks(v.v), x.v); };
    const auto high = [&](Lanes x, Lanes v)
                          MSSIM_INLINE_LAMBDA { return hn::OddEvenBlocks(v.v, hn::SwapAdjacentBlocks(x.v)); };
    Vector records[8];  // record i, with 16 lanes followed by record i + 8
    transpose_blocks<Vector>(low(node.x.x, node.v.x), low(node.x.y, node.v.y), low(node.x.z, node.v.z), zero,
                             records);
    transpose_blocks<Vector>(high(node.x.x, node.v.x), high(node.x.y, node.v.y), high(node.x.z, node.v.z),
                             zero, records + 4);
    for (std::size_t i = 0; i < 8; ++i) {
      if constexpr (lanes == 16) {
        const hn::Half<RealTag> half;
        hn::Store(hn::LowerHalf(half, records[i]), half, to + 8 * i);
        hn::Store(hn::UpperHalf(half, records[i]), half, to + 8 * (i + 8));
      } else {
        hn::Store(records[i], d, to + 8 * i);
      }
    }
  }
}

#endif

/// Loads the nodes whose records are at record(0), record(1) ..., one per lane.
template <std::size_t lanes, class Record>
HWY_INLINE NodeLanes load_records(Record record) {
  const TransposedRecords<lanes> all(record);
  return {{all.first(0), all.first(1), all.first(2)}, {all.last(0), all.last(1), all.last(2)}};
}

constexpr std::size_t vector_nodes = hn::MaxLanes(RealTag());

/// Start of each pair's nodes, by role.
using Pairs = std::array<Real*, pair_kinds>;

/// Loads the nodes of contiguous records from `first` on.
HWY_INLINE NodeLanes load_nodes(const Real* first) {
  return load_records<vector_nodes>([&](std::size_t i)
                                        MSSIM_INLINE_LAMBDA { return first + i * record_floats; });
}

/// One stage at the nodes whose records begin `offset` numbers after each pair's start. `pull`: the
/// acceleration from the springs; `node`: the gathered pair; nodes not `free` are unchanged.
template <std::size_t method, std::size_t stage>
HWY_INLINE void update_nodes(const Pairs& pairs, std::size_t offset, const NodeLanes& node,
                             const Lanes3& pull, Mask free, const Coefficients<Real>& coefficients,
                             const SurroundingsOf<Real>& surroundings) {
  constexpr Stage table = integrators[method].stages[stage];
  NodeLanes loaded[pair_kinds];
  const auto half = [&](auto slot) MSSIM_INLINE_LAMBDA -> Lanes3& {
    constexpr std::size_t i = index(decltype(slot)::value);
    return i % 2 == 0 ? loaded[i / 2].x : loaded[i / 2].v;
  };
  const auto for_each_pair = [](auto&& act) MSSIM_INLINE_LAMBDA {
    [&]<std::size_t... pair>(std::index_sequence<pair...>) MSSIM_INLINE_LAMBDA {
      (act(std::integral_constant<std::size_t, pair>{}), ...);
    }
    (std::make_index_sequence<pair_kinds>{});
  };
  for_each_pair([&](auto i) MSSIM_INLINE_LAMBDA {
    constexpr Pair pair = static_cast<Pair>(decltype(i)::value);
    static_assert(writes(table, position_slot(pair)) == writes(table, velocity_slot(pair)),
                  "a record is written whole");
    if constexpr (pair != table.gather &&
                  (reads(table, position_slot(pair)) || reads(table, velocity_slot(pair))))
      loaded[i] = load_nodes(pairs[i] + offset);
  });
  update_lanes<method, stage>(node, pull, free, Lanes(surroundings.gravity), coefficients, surroundings, half,
                              [&](auto slot, const Lanes3& value)
                                  MSSIM_INLINE_LAMBDA { half(slot) = value; });
  for_each_pair([&](auto i) MSSIM_INLINE_LAMBDA {
    if constexpr (writes(table, position_slot(static_cast<Pair>(decltype(i)::value))))
      store_records<vector_nodes>(pairs[i] + offset, loaded[i]);
  });
}

}  // namespace MSSIM_PRECISION
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
