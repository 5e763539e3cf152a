#pragma once

#include "backends/interface/surroundings.h"
#include "backends/layouts/aligned_array.h"
#include "backends/layouts/packed_springs.h"
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

}  // namespace mssim
