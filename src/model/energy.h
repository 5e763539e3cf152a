#pragma once

#include <string_view>

#include "model/system.h"

namespace mssim {

/// The mechanical energy of a state, J.
struct Energy {
  double kinetic = 0;
  double elastic = 0;        ///< of all springs, zero at rest length
  double gravitational = 0;  ///< zero on the floor
  double total() const { return kinetic + elastic + gravitational; }
};

/// What has been taken from the mechanical energy since the start, J.
struct EnergyLosses {
  double damping = 0;      ///< by the springs and by the air
  double friction = 0;     ///< by sliding on the floor
  double bounce = 0;       ///< by the floor otherwise; below zero where putting nodes back onto it gives more
  double integration = 0;  ///< by the integrator's error off the floor; below zero where it feeds energy in
  double total() const { return damping + friction + bounce + integration; }
};

/// Energy of `state` in double precision. Pinned nodes count, at their constant height.
Energy energy_of(const System& system, const State& state);

/// What does work on the nodes and is in none of these energies, in words; empty where there is nothing but
/// what EnergyLosses account for.
std::string_view energies_leave_out(const System& system);

/// Energy of one spring, J.
double elastic_energy(const System& system, const Spring& spring, const State& state);

/// What damping of the springs and of the air takes in `state`, W: the sum of c ((u . d) / |d|)^2 over all
/// springs, d and u the differences of positions and velocities of their ends, and of viscous_damping m v^2
/// over all nodes.
double damping_power(const System& system, const State& state);

}  // namespace mssim
