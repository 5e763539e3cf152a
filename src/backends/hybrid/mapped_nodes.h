#pragma once

#include <array>
#include <cstddef>

#include "integrators/integrator.h"

namespace mssim {

/// What a stage reads and writes, as mapped: `pairs` by role, and the forces of all springs, in the layout of
/// the nodes that it belongs to.
struct MappedNodes {
  std::array<float*, pair_kinds> pairs{};
  const float* forces = nullptr;
};

/// The host's vector code for one instruction set, for nodes in a layout (HostNodes, AlikeNodes).
template <class Nodes>
struct NodeKernel {
  const char* instruction_set;  ///< Highway's name for it
  /// Sums the forces at the nodes of the slices [begin, end) and runs the assignments of a stage.
  void (*integrate)(const Nodes& nodes, const MappedNodes& mapped, std::size_t stage, std::size_t begin,
                    std::size_t end);
};

}  // namespace mssim
