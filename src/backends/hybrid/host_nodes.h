#pragma once

#include <array>
#include <cstddef>

#include "backends/aligned_array.h"
#include "backends/packed_springs.h"
#include "backends/surroundings.h"
#include "integrators/coefficients.h"
#include "model/system.h"

namespace mssim {

/// What the host's threads need to sum the spring forces at the nodes and to integrate them, with one
/// integrator and one dt.
struct HostNodes {
  PackedSprings packed;
  const Integrator* integrator;
  Coefficients<float> coefficients;
  Surroundings surroundings;
  /// [slices][inverse mass, held][16]: 1/kg; 1 where nothing may move (pinned, or no node), else 0.
  AlignedArray constants;

  HostNodes(const System& system, const Integrator& method, double dt_s);
};

/// What a stage reads and writes, as mapped: `pairs` by role, records of eight floats (kernels/records.h) for
/// each place; `forces` as PackedSprings places them, four floats each.
struct MappedNodes {
  std::array<float*, pair_kinds> pairs{};
  const float* forces = nullptr;
};

/// The vector code for one instruction set.
struct NodeKernel {
  const char* instruction_set;  ///< Highway's name for it
  /// Sums the forces at the nodes of the slices [begin, end) and runs the lines of a stage.
  void (*integrate)(const HostNodes& nodes, const MappedNodes& mapped, std::size_t stage, std::size_t begin,
                    std::size_t end);
};

/// The kernel for the best instruction set of this processor.
NodeKernel best_node_kernel();

}  // namespace mssim
