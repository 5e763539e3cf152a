#pragma once

#include <cstdint>
#include <vector>

#include "backends/hybrid/spring_kernel.h"
#include "backends/interface/backend.h"
#include "backends/layouts/alike_springs.h"
#include "integrators/coefficients.h"
#include "model/system.h"

namespace mssim {

/// HostNodes for alike bodies: what the host's threads need to sum the forces of their springs and to
/// integrate.
struct AlikeNodes {
  AlikeSprings springs;
  const Integrator* integrator;
  Coefficients<float> coefficients;
  Surroundings surroundings;

  /// `bodies`: all of the system.
  AlikeNodes(const System& system, const std::vector<AlikeBodies>& bodies, const Integrator& method,
             double dt_s);

  std::size_t slices() const { return springs.slices.count; }
  void write(const State& state, float* pair) const { springs.slices.write(state, pair); }
  State read(const float* pair) const { return springs.slices.read(pair); }
  std::uint64_t stored_springs() const { return springs.subtracted.size(); }
  /// What the device is to do. It refers to this.
  SpringKernel spring_kernel(int lanes) const;
  /// Gives up what the device has a copy of.
  void forget_units() { springs.springs = {}; }
};

}  // namespace mssim
