// What a stage does with the nodes of one vector, whose records follow each other, once the springs'
// acceleration is known. Compiled once per instruction set, so the guard toggles.
#if defined(MSSIM_UPDATE_NODES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_UPDATE_NODES_INL_H_
#undef MSSIM_UPDATE_NODES_INL_H_
#else
#define MSSIM_UPDATE_NODES_INL_H_
#endif

#include <array>
#include <utility>

#include "backends/layouts/node_records.h"
#include "backends/layouts/records-inl.h"
#include "backends/layouts/update_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

constexpr std::size_t vector_nodes = hn::MaxLanes(FloatTag());

/// Where each pair's nodes start, by role.
using Pairs = std::array<float*, pair_kinds>;

/// The nodes whose records follow each other from `first` on.
HWY_INLINE NodeLanes load_nodes(const float* first) {
  return load_records<vector_nodes>([&](std::size_t i)
                                        MSSIM_INLINE_LAMBDA { return first + i * record_floats; });
}

/// One stage at the nodes whose records begin `offset` floats after each pair's. `pull`: the acceleration
/// that the springs give them; `node`: what they are in the gathered pair; those not `free` stay as they are.
template <std::size_t method, std::size_t stage>
HWY_INLINE void update_nodes(const Pairs& pairs, std::size_t offset, const NodeLanes& node,
                             const Lanes3& pull, Mask free, const Coefficients<float>& coefficients,
                             const Surroundings& surroundings) {
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

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
