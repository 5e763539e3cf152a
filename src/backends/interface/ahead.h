#pragma once

#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// Moves positions back along the velocities, from where an integrator that is so many seconds ahead sees
/// them to where the state has them. A node that this would take below the floor (its height in m), because
/// it has just met it, is put onto the floor.
void move_back(State& state, double seconds, double floor);

/// `backend`, whose stages see positions integrator.ahead of a step ahead of the state's: what goes in is
/// moved along its velocity, and what comes out back. `system` must outlive it. An integrator that is not
/// ahead leaves the backend as it is.
std::unique_ptr<Backend> step_ahead(std::unique_ptr<Backend> backend, const System& system,
                                    const Integrator& integrator, double dt_s);

}  // namespace mssim
