#include "backends/vectors/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/hybrid/integrate_nodes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <type_traits>

#include "backends/hybrid/integrate_nodes.h"
#include "backends/layouts/records-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

constexpr std::size_t slice_nodes = PackedSprings::slice_nodes;
static_assert(slice_nodes == AlikeSprings::slice_nodes);
constexpr std::size_t slice_floats = 4 * slice_nodes;  // of forces

/// A force and a zero in a 128-bit register, which every x86-64 and ARM64 CPU has.
using Quad = float __attribute__((vector_size(16)));

/// The forces to add at the slice's nodes, in the order of forces: the sum of its entries, in one stream.
HWY_INLINE void add_forces(const PackedSprings& packed, const float* forces, std::size_t slice, float* sums) {
  const RealTag d;
  constexpr std::size_t at_a_time = 4 * vector_nodes;
  const float* end = forces + packed.first_entry[slice + 1] * slice_floats;
  for (std::size_t from = 0; from < slice_floats; from += at_a_time) {
    Lanes sum[4] = {Lanes(0.0F), Lanes(0.0F), Lanes(0.0F), Lanes(0.0F)};
    for (const float* entry = forces + packed.first_entry[slice] * slice_floats; entry < end;
         entry += slice_floats)
      for (std::size_t i = 0; i < 4; ++i)
        sum[i] = sum[i] + Lanes(hn::Load(d, entry + from + i * vector_nodes));
    for (std::size_t i = 0; i < 4; ++i) hn::Store(sum[i].v, d, sums + from + i * vector_nodes);
  }
}

/// Subtracts from the sums the forces of springs that end at the slice's nodes.
HWY_INLINE void subtract_forces(const PackedSprings& packed, const float* forces, std::size_t slice,
                                float* sums) {
  constexpr std::size_t list_nodes = PackedSprings::list_nodes, lists = slice_nodes / list_nodes;
  const auto* all = reinterpret_cast<const Quad*>(forces);
  auto* of_node = reinterpret_cast<Quad*>(sums);
  for (std::size_t list = 0; list < lists; ++list) {
    const std::uint32_t* bound = packed.first_subtracted.data() + slice * lists + list;
    const std::uint32_t* end = packed.subtracted.data() + std::size_t{bound[1]} * list_nodes;
    Quad sum[list_nodes];
    for (std::size_t i = 0; i < list_nodes; ++i)
      sum[i] = of_node[PackedSprings::force_place(list * list_nodes + i)];
    for (const std::uint32_t* force = packed.subtracted.data() + std::size_t{bound[0]} * list_nodes;
         force != end; force += list_nodes)
      for (std::size_t i = 0; i < list_nodes; ++i) sum[i] = sum[i] - all[force[i]];
    for (std::size_t i = 0; i < list_nodes; ++i)
      of_node[PackedSprings::force_place(list * list_nodes + i)] = sum[i];
  }
}

/// The sums of a vector of a slice's nodes, starting with number `node`.
HWY_INLINE Lanes3 load_sums(const float* sums, std::size_t node) {
#if HWY_TARGET == HWY_SCALAR
  const float* sum = sums + 4 * PackedSprings::force_place(node);
  return {sum[0], sum[1], sum[2]};
#else
  const RealTag d;
  hn::Vec<RealTag> component[4];
  transpose_blocks(hn::Load(d, sums + node), hn::Load(d, sums + slice_nodes + node),
                   hn::Load(d, sums + 2 * slice_nodes + node), hn::Load(d, sums + 3 * slice_nodes + node),
                   component);
  return {component[0], component[1], component[2]};
#endif
}

template <std::size_t method, std::size_t stage>
HWY_NOINLINE void integrate_slices(const HostNodes& nodes, const MappedNodes& mapped, std::size_t begin,
                                   std::size_t end) {
  // A few slices per pass, as many as the first-level cache holds. First the additions, whose stream brings
  // the data of the later lookups into the cache. Sums are complete before they are loaded as vectors: a load
  // of a vector cannot be forwarded from narrower stores.
  constexpr std::size_t at_a_time = 4;
  alignas(64) float sums[at_a_time * slice_floats];
  const PackedSprings& packed = nodes.packed;
  for (; begin < end; begin += at_a_time) {
    const std::size_t some = std::min(at_a_time, end - begin);
    for (std::size_t i = 0; i < some; ++i)
      add_forces(packed, mapped.forces, begin + i, sums + i * slice_floats);
    for (std::size_t i = 0; i < some; ++i)
      subtract_forces(packed, mapped.forces, begin + i, sums + i * slice_floats);
    for (std::size_t i = 0; i < some; ++i) {
      const std::size_t slice = begin + i;
      const float* constants = nodes.constants.data() + slice * 2 * slice_nodes;
      for (std::size_t number = 0; number < slice_nodes; number += vector_nodes) {
        const Lanes3 force = load_sums(sums + i * slice_floats, number);
        const Lanes inverse_mass = hn::Load(RealTag(), constants + number);
        const Mask free = hn::Eq(hn::Load(RealTag(), constants + slice_nodes + number), hn::Zero(RealTag()));
        const std::size_t offset = (slice * slice_nodes + number) * record_floats;
        const NodeLanes node =
            load_nodes(mapped.pairs[index(integrators[method].stages[stage].gather)] + offset);
        update_nodes<method, stage>(mapped.pairs, offset, node, inverse_mass * force, free,
                                    nodes.coefficients, nodes.surroundings);
      }
    }
  }
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
        sum = sum + load3(forces + s * force_floats, slice_nodes);
      for (const std::uint32_t s : springs.subtracted.of(slice))
        sum = sum - load3(forces + std::size_t{s} * force_floats, slice_nodes);
      const auto at = [&](auto slot) MSSIM_INLINE_LAMBDA {
        constexpr std::size_t number = index(decltype(slot)::value);
        return pairs[number / 2] + (2 * slice + number % 2) * force_floats + lane;
      };
      const auto load = [&](auto slot) MSSIM_INLINE_LAMBDA { return load3(at(slot), slice_nodes); };
      constexpr Pair gathered = integrators[method].stages[stage].gather;
      const NodeLanes node{load(std::integral_constant<Slot, position_slot(gathered)>{}),
                           load(std::integral_constant<Slot, velocity_slot(gathered)>{})};
      const Mask free = hn::FirstN(RealTag(), springs.pinned[slice] != 0 ? 0 : lane_count());
      update_lanes<method, stage>(
          node, sum, free, Lanes(nodes.surroundings.gravity), nodes.coefficients, nodes.surroundings, load,
          [&](auto slot, const Lanes3& value) MSSIM_INLINE_LAMBDA { store3(at(slot), value, slice_nodes); });
    }
}

template <class Nodes>
void integrate(const Nodes& nodes, const MappedNodes& mapped, std::size_t number, std::size_t begin,
               std::size_t end) {
  with_integrator(*nodes.integrator, [&](auto method) HWY_ATTR {
    for_each_stage<method>([&](auto stage) HWY_ATTR {
      if (number == stage) integrate_slices<method, stage>(nodes, mapped, begin, end);
    });
  });
}

NodeKernel<HostNodes> node_kernel() { return {hwy::TargetName(HWY_TARGET), &integrate<HostNodes>}; }
NodeKernel<AlikeNodes> alike_node_kernel() { return {hwy::TargetName(HWY_TARGET), &integrate<AlikeNodes>}; }

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(node_kernel);
HWY_EXPORT(alike_node_kernel);
std::vector<NodeKernel<HostNodes>> node_kernels() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(node_kernel));
}
std::vector<NodeKernel<AlikeNodes>> alike_node_kernels() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(alike_node_kernel));
}
}  // namespace mssim
#endif
