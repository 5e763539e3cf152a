#pragma once

#include "model/system.h"

namespace mssim {

/// The mechanical energy of a state, J.
struct Energy {
  double kinetic = 0;
  double elastic = 0;        ///< of all springs, zero at rest length
  double gravitational = 0;  ///< zero on the floor
  double total() const { return kinetic + elastic + gravitational; }
};

/// Energy of `state` in double precision. Pinned nodes count, at their constant height.
Energy energy_of(const System& system, const State& state);

}  // namespace mssim
