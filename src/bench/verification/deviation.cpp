#include "bench/verification/deviation.h"

#include <algorithm>
#include <cmath>

namespace mssim {

double position_deviation(const System& system, const State& reference, const State& state) {
  double largest = 0;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    const Vec3d d = state.position[i] - reference.position[i];
    largest = std::max(largest, dot(d, d));
  }
  return std::sqrt(largest) / mean_rest_length(system);
}

Deviation deviation_from(const System& system, const State& reference, const Energy& energy,
                         const State& state) {
  return {position_deviation(system, reference, state),
          (energy_of(system, state).total() - energy.total()) / (energy.kinetic + energy.elastic)};
}

}  // namespace mssim
