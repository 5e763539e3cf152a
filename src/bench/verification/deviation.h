#pragma once

#include "model/energy.h"

namespace mssim {

/// How far a state is from another one of the same system.
struct Deviation {
  double position = 0;  ///< largest distance between the same node's positions, in mean rest lengths
  double energy = 0;    ///< total energy less the other's, over the other's energy in motion
};

/// What differences from the energy of a state are a share of, J: its kinetic and elastic energy, and of one
/// at rest a hundred times the elastic energy of what single precision rounds. Of a spring that is
/// k / 2 (8 u)^2 |x|^2 / 3, x the place of its end and u = 2^-24: backends in single precision end 8 to 12
/// roundings of a coordinate away from the reference after 100 steps (position_tolerance).
double energy_in_motion(const System& system, const State& state, const Energy& energy);

/// `state` against `reference`, whose energy is `energy`.
Deviation deviation_from(const System& system, const State& reference, const Energy& energy,
                         const State& state);

/// The largest distance between the same node's positions, in mean rest lengths.
double position_deviation(const System& system, const State& reference, const State& state);

}  // namespace mssim
