#pragma once

#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// xpbd (integrators/all_integrators.h). `system` is no garment and outlives the backend.

/// By plain loops over the spring list on one thread.
std::unique_ptr<Backend> make_serial_constraints(const System& system, double dt_s);

/// The plain solver in double precision.
std::unique_ptr<Backend> make_constraints_reference(const System& system, double dt_s);

/// With vectors, on as many threads: the same bits at every number of them.
std::unique_ptr<Backend> make_openmp_constraints(const System& system, double dt_s,
                                                 const ExecutionOptions& options);

}  // namespace mssim
