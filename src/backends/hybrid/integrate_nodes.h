#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "backends/hybrid/host_nodes.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// What a stage reads and writes, as mapped: `pairs` by role, records of eight floats (kernels/records.h) for
/// each slot; `forces` as PackedSprings places them, four floats each.
struct MappedNodes {
  std::array<float*, pair_kinds> pairs{};
  const float* forces = nullptr;
};

/// The vector code for one instruction set.
struct NodeKernel {
  const char* instruction_set;  ///< Highway's name for it
  /// Sums the forces at the nodes of the slices [begin, end) and runs the assignments of a stage.
  void (*integrate)(const HostNodes& nodes, const MappedNodes& mapped, std::size_t stage, std::size_t begin,
                    std::size_t end);
};

/// The kernels that this processor can run, the best first.
std::vector<NodeKernel> node_kernels();

}  // namespace mssim
