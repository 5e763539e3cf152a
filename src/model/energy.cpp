#include "model/energy.h"

#include <cmath>

namespace mssim {

Energy energy_of(const System& system, const State& state) {
  Energy energy;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    const double mass = system.node_mass[i];
    energy.kinetic += 0.5 * mass * dot(state.velocity[i], state.velocity[i]);
    energy.gravitational += mass * system.gravity * (state.position[i].y - system.floor.height);
  }
  for (const Spring& spring : system.springs) {
    const Vec3d d = state.position[spring.second] - state.position[spring.first];
    const double stretch = std::sqrt(dot(d, d)) - static_cast<double>(spring.rest_length);
    energy.elastic += 0.5 * system.materials[spring.kind].stiffness * stretch * stretch;
  }
  return energy;
}

}  // namespace mssim
