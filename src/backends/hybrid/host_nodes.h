#pragma once

#include <cstdint>
#include <vector>

#include "backends/hybrid/spring_kernel.h"
#include "backends/interface/backend.h"
#include "backends/layouts/aligned_array.h"
#include "backends/layouts/node_records.h"
#include "backends/layouts/packed_springs.h"
#include "integrators/coefficients.h"
#include "model/system.h"

namespace mssim {

/// What the host's threads need to sum the spring forces at the nodes and to integrate them, with one
/// integrator and one dt. Nodes are records (kernels/records.h), forces lie as PackedSprings places them,
/// four floats each, N.
struct HostNodes {
  PackedSprings packed;
  const Integrator* integrator;
  Coefficients<float> coefficients;
  Surroundings surroundings;
  /// [slices][inverse mass, held][16]: 1/kg; 1 where nothing may move (pinned, or no node), else 0.
  AlignedArray constants;
  struct Material {
    float stiffness;  // N/m
    float damping;    // N s/m
  };
  std::vector<Material> materials;  ///< of the system, by kind

  HostNodes(const System& system, const Integrator& method, double dt_s);

  std::size_t slices() const { return packed.slices(); }
  void write(const State& state, float* pair) const { write_records(state, packed.slot, pair); }
  State read(const float* pair) const { return read_records(pair, packed.slot); }
  /// What the device is to do. It refers to this.
  SpringKernel spring_kernel(int lanes) const;
  /// Gives up what the device has a copy of.
  void forget_units();
};

}  // namespace mssim
