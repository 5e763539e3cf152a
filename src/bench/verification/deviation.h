#pragma once

#include "model/energy.h"

namespace mssim {

/// How far a state is from another one of the same system.
struct Deviation {
  double position = 0;  ///< largest distance between the same node's positions, in mean rest lengths
  double energy = 0;    ///< total energy less the other's, over the other's kinetic + elastic energy
};

/// `state` against `reference`, whose energy is `energy`.
Deviation deviation_from(const System& system, const State& reference, const Energy& energy,
                         const State& state);

/// The largest distance between the same node's positions, in mean rest lengths.
double position_deviation(const System& system, const State& reference, const State& state);

}  // namespace mssim
