#include "bench/verification/deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mssim {

double position_deviation(const System& system, const State& reference, const State& state) {
  double largest = 0;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    const Vec3d d = state.position[i] - reference.position[i];
    largest = std::max(largest, dot(d, d));
  }
  return std::sqrt(largest) / mean_rest_length(system);
}

double energy_in_motion(const System& system, const State& state, const Energy& energy) {
  constexpr double share = 0.01, rounding = 8 * 0x1p-24;
  double rounded = 0;
  for (const Spring& spring : system.springs) {
    const Vec3d& x = state.position[spring.first];
    rounded += system.materials[spring.kind].stiffness / 2 * rounding * rounding * dot(x, x) / 3;
  }
  // Of what has no springs that resist, and does not move, nothing.
  return std::max({energy.kinetic + energy.elastic, rounded / share, std::numeric_limits<double>::min()});
}

Deviation deviation_from(const System& system, const State& reference, const Energy& energy,
                         const State& state) {
  return {position_deviation(system, reference, state),
          (energy_of(system, state).total() - energy.total()) / energy_in_motion(system, reference, energy)};
}

}  // namespace mssim
