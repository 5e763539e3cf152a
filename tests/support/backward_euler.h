#pragma once

#include "model/system.h"
#include "tests/support/testing.h"
#include "tests/support/textbook_force.h"

namespace mssim {

/// Forces on all nodes, N, from the formulas of model/system.h; zero on pinned ones.
inline std::vector<Vec3d> forces(const System& system, const State& state) {
  std::vector<Vec3d> force(system.nodes());
  for (const Spring& spring : system.springs) {
    const Vec3d d = state.position[spring.second] - state.position[spring.first];
    const Vec3d u = state.velocity[spring.second] - state.velocity[spring.first];
    const Vec3d f =
        textbook_force(system.materials[spring.kind], static_cast<double>(spring.rest_length), d, u);
    force[spring.first] += f;
    force[spring.second] -= f;
  }
  for (std::size_t i = 0; i < system.nodes(); ++i)
    force[i] +=
        system.node_mass[i] * (Vec3d{0, -system.gravity, 0} - system.viscous_damping * state.velocity[i]);
  for (const std::uint32_t pin : system.pins) force[pin] = {};
  return force;
}

/// |M (w - v) - dt F(x + dt w, w)| in the norm of M^-1, where `after` is what w leads to.
inline double residual_of(const System& system, const State& before, const State& after, double dt_s) {
  const std::vector<Vec3d> force = forces(system, after);
  double sum = 0;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    const Vec3d r = system.node_mass[i] * (after.velocity[i] - before.velocity[i]) - dt_s * force[i];
    sum += dot(r, r) / system.node_mass[i];
  }
  return std::sqrt(sum);
}

}  // namespace mssim
