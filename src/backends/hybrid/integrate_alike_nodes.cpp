// Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/hybrid/integrate_alike_nodes.cpp"
#include "backends/hybrid/integrate_alike_nodes.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <array>
#include <type_traits>

#include "backends/layouts/update_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

constexpr std::size_t slice_nodes = AlikeSprings::slice_nodes;

/// Three components of a slice's nodes from one on.
HWY_INLINE Lanes3 load_of_slice(const float* from) {
  const FloatTag d;
  return {hn::Load(d, from), hn::Load(d, from + slice_nodes), hn::Load(d, from + 2 * slice_nodes)};
}
HWY_INLINE void store_to_slice(float* to, const Lanes3& value) {
  const FloatTag d;
  hn::Store(value.x.v, d, to);
  hn::Store(value.y.v, d, to + slice_nodes);
  hn::Store(value.z.v, d, to + 2 * slice_nodes);
}

template <std::size_t method, std::size_t stage>
HWY_NOINLINE void integrate_slices(const AlikeNodes& nodes, const MappedNodes& mapped, std::size_t begin,
                                   std::size_t end) {
  constexpr std::size_t force_floats = 3 * slice_nodes;
  const AlikeSprings& springs = nodes.springs;
  const std::array<float*, pair_kinds> pairs = mapped.pairs;
  for (std::size_t slice = begin; slice < end; ++slice)
    for (std::size_t lane = 0; lane < slice_nodes; lane += lane_count()) {
      const float* const forces = mapped.forces + lane;
      Lanes3 sum = zero3();
      for (std::size_t s = springs.first_end[slice]; s < springs.first_end[slice + 1]; ++s)
        sum = sum + load_of_slice(forces + s * force_floats);
      for (std::size_t i = springs.first_subtracted[slice]; i < springs.first_subtracted[slice + 1]; ++i)
        sum = sum - load_of_slice(forces + std::size_t{springs.subtracted[i]} * force_floats);
      const auto at = [&](auto slot) MSSIM_INLINE_LAMBDA {
        constexpr std::size_t number = index(decltype(slot)::value);
        return pairs[number / 2] + (2 * slice + number % 2) * force_floats + lane;
      };
      const auto load = [&](auto slot) MSSIM_INLINE_LAMBDA { return load_of_slice(at(slot)); };
      constexpr Pair gathered = integrators[method].stages[stage].gather;
      const NodeLanes node{load(std::integral_constant<Slot, position_slot(gathered)>{}),
                           load(std::integral_constant<Slot, velocity_slot(gathered)>{})};
      const Mask free = hn::FirstN(FloatTag(), springs.pinned[slice] != 0 ? 0 : lane_count());
      update_lanes<method, stage>(
          node, sum, free, Lanes(nodes.surroundings.gravity), nodes.coefficients, nodes.surroundings, load,
          [&](auto slot, const Lanes3& value) MSSIM_INLINE_LAMBDA { store_to_slice(at(slot), value); });
    }
}

void integrate(const AlikeNodes& nodes, const MappedNodes& mapped, std::size_t number, std::size_t begin,
               std::size_t end) {
  with_integrator(*nodes.integrator, [&](auto method) HWY_ATTR {
    for_each_stage<method>([&](auto stage) HWY_ATTR {
      if (number == stage) integrate_slices<method, stage>(nodes, mapped, begin, end);
    });
  });
}

NodeKernel<AlikeNodes> alike_node_kernel() { return {hwy::TargetName(HWY_TARGET), &integrate}; }

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(alike_node_kernel);
std::vector<NodeKernel<AlikeNodes>> alike_node_kernels() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(alike_node_kernel));
}
}  // namespace mssim
#endif
