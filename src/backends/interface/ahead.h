#pragma once

#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// `backend`, whose stages see positions integrator.ahead of a step ahead of the state's: what goes in is
/// moved along its velocity, and what comes out back. A node that this would take below the floor, because
/// it has just met it, comes out on the floor. `system` must outlive it. An integrator that is not ahead
/// leaves the backend as it is.
std::unique_ptr<Backend> step_ahead(std::unique_ptr<Backend> backend, const System& system,
                                    const Integrator& integrator, double dt_s);

}  // namespace mssim
