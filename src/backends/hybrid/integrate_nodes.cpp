// Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/hybrid/integrate_nodes.cpp"
#include "backends/hybrid/integrate_nodes.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "backends/sliced_graph/update_nodes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

constexpr std::size_t slice_nodes = PackedSprings::slice_nodes;
constexpr std::size_t slice_floats = 4 * slice_nodes;  // of forces

/// A force and a zero in one 128-bit register, which every x86-64 and ARM64 processor has.
using Quad = float __attribute__((vector_size(16)));

/// Minus the sum of what the slice's nodes are to subtract, placed as forces are.
HWY_INLINE void subtract_forces(const PackedSprings& packed, const float* forces, std::size_t slice,
                                float* sums) {
  constexpr std::size_t lists = slice_nodes / PackedSprings::list_nodes;
  for (std::size_t list = 0; list < lists; ++list) {
    const std::uint32_t* bound = packed.first_subtracted.data() + slice * lists + list;
    const auto* all = reinterpret_cast<const Quad*>(forces);
    const std::uint32_t* end = packed.subtracted.data() + std::size_t{bound[1]} * PackedSprings::list_nodes;
    Quad sum[PackedSprings::list_nodes] = {};
    for (const std::uint32_t* of =
             packed.subtracted.data() + std::size_t{bound[0]} * PackedSprings::list_nodes;
         of != end; of += PackedSprings::list_nodes)
      for (std::size_t i = 0; i < PackedSprings::list_nodes; ++i) sum[i] = sum[i] - all[of[i]];
    for (std::size_t i = 0; i < PackedSprings::list_nodes; ++i)
      reinterpret_cast<Quad*>(sums)[PackedSprings::force_place(list * PackedSprings::list_nodes + i)] =
          sum[i];
  }
}

/// `sums` and the forces of `entries` entries, which begin at `forces`, at a vector of a slice's nodes, from
/// number `node` on.
HWY_INLINE Lanes3 add_forces(const float* forces, std::size_t entries, const float* sums, std::size_t node) {
#if HWY_TARGET == HWY_SCALAR
  const std::size_t at = 4 * PackedSprings::force_place(node);
  Lanes3 sum{sums[at], sums[at + 1], sums[at + 2]};
  for (std::size_t entry = 0; entry < entries; ++entry) {
    const float* force = forces + entry * slice_floats + at;
    sum = sum + Lanes3{force[0], force[1], force[2]};
  }
  return sum;
#else
  const FloatTag d;
  hn::Vec<FloatTag> sum[4], component[4];
  for (std::size_t i = 0; i < 4; ++i) sum[i] = hn::Load(d, sums + slice_nodes * i + node);
  for (const float* end = forces + entries * slice_floats; forces < end; forces += slice_floats)
    for (std::size_t i = 0; i < 4; ++i)
      sum[i] = hn::Add(sum[i], hn::Load(d, forces + slice_nodes * i + node));
  transpose_blocks(sum[0], sum[1], sum[2], sum[3], component);
  return {component[0], component[1], component[2]};
#endif
}

template <std::size_t method, std::size_t stage>
HWY_NOINLINE void integrate_slices(const HostNodes& nodes, const MappedNodes& mapped, std::size_t begin,
                                   std::size_t end) {
  // Subtracted some slices ahead: the vectors below could not be loaded right after the narrower stores.
  constexpr std::size_t ahead = 16;
  alignas(64) float sums[ahead * slice_floats];
  const PackedSprings& packed = nodes.packed;
  for (; begin < end; begin += ahead) {
    const std::size_t some = std::min(ahead, end - begin);
    for (std::size_t i = 0; i < some; ++i)
      subtract_forces(packed, mapped.forces, begin + i, sums + i * slice_floats);
    for (std::size_t i = 0; i < some; ++i) {
      const std::size_t slice = begin + i, first = packed.first_entry[slice];
      const float* constants = nodes.constants.data() + slice * 2 * slice_nodes;
      for (std::size_t number = 0; number < slice_nodes; number += vector_nodes) {
        const Lanes3 force =
            add_forces(mapped.forces + first * slice_floats, packed.first_entry[slice + 1] - first,
                       sums + i * slice_floats, number);
        const Lanes inverse_mass = hn::Load(FloatTag(), constants + number);
        const Mask free =
            hn::Eq(hn::Load(FloatTag(), constants + slice_nodes + number), hn::Zero(FloatTag()));
        const std::size_t offset = (slice * slice_nodes + number) * record_floats;
        const NodeLanes node =
            load_nodes(mapped.pairs[index(integrators[method].stages[stage].gather)] + offset);
        update_nodes<method, stage>(mapped.pairs, offset, node, inverse_mass * force, free,
                                    nodes.coefficients, nodes.surroundings);
      }
    }
  }
}

void integrate(const HostNodes& nodes, const MappedNodes& mapped, std::size_t number, std::size_t begin,
               std::size_t end) {
  with_integrator(*nodes.integrator, [&](auto method) HWY_ATTR {
    for_each_stage<method>([&](auto stage) HWY_ATTR {
      if (number == stage) integrate_slices<method, stage>(nodes, mapped, begin, end);
    });
  });
}

NodeKernel node_kernel() { return {hwy::TargetName(HWY_TARGET), &integrate}; }

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(node_kernel);
std::vector<NodeKernel> node_kernels() { return kernels_of_this_processor(HWY_DISPATCH_TABLE(node_kernel)); }
}  // namespace mssim
#endif
