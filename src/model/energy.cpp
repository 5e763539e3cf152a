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
  for (const Spring& spring : system.springs) energy.elastic += elastic_energy(system, spring, state);
  return energy;
}

std::string_view energies_leave_out(const System& system) {
  if (!std::holds_alternative<Garment>(system.topology)) return "";
  return "the work of seams, of contacts and of the correction of elongations; and gravitational energy "
         "counts "
         "in full also while seams close, when gravity need not act in full";
}

double elastic_energy(const System& system, const Spring& spring, const State& state) {
  const Vec3d d = state.position[spring.second] - state.position[spring.first];
  const double stretch = length(d) - static_cast<double>(spring.rest_length);
  return 0.5 * system.materials[spring.kind].stiffness * stretch * stretch;
}

double damping_power(const System& system, const State& state) {
  double power = 0;
  for (std::size_t i = 0; i < system.nodes(); ++i)
    power += system.viscous_damping * system.node_mass[i] * dot(state.velocity[i], state.velocity[i]);
  for (const Spring& spring : system.springs) {
    const Vec3d d = state.position[spring.second] - state.position[spring.first];
    const double closing = dot(state.velocity[spring.second] - state.velocity[spring.first], d);
    power += system.materials[spring.kind].damping * closing * closing / dot(d, d);
  }
  return power;
}

}  // namespace mssim
