#pragma once

#include <optional>

#include "backends/interface/backend.h"

namespace mssim {

/// Growth of the total energy, as a share of what there is at the start, that no run of a stable step shows.
/// Little, because what is unstable need not blow up: large motions are not linear, and may end at several
/// times the energy. Near the limit of a symplectic method a stable oscillation, too, takes its energy up and
/// down; where modes that stiff carry a large share of the energy and nothing damps them, that counts as
/// growth.
inline constexpr double allowed_energy_growth = 0.01;

/// The largest total energy, J, that a run of `system` may have: that of its start, and allowed_energy_growth
/// of its kinetic and elastic energy and of what gravity can still give (down to the floor, or along the
/// free fall of `span_s`, whichever is less). Springs, gravity, pins, which are at rest, and the floor add
/// nothing to the total of kinetic, elastic and gravitational energy; damping takes of it. So what comes in
/// is the integrator's.
double energy_bound(const System& system, double span_s);

/// Lets the backend take `steps` steps from the system's start, and looks at the state some thirty times on
/// the way: whether all numbers stay finite and the total energy below the bound.
bool stays_below(Backend& backend, const System& system, int steps, double bound_j);

}  // namespace mssim
