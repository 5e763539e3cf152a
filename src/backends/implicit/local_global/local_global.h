#pragma once

#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// fast-springs (integrators/all_integrators.h). `system` is no garment and outlives the backend.

/// By plain loops over the spring list on one thread.
std::unique_ptr<Backend> make_serial_local_global(const System& system, double dt_s);

/// The same in double precision.
std::unique_ptr<Backend> make_local_global_reference(const System& system, double dt_s);

/// With vectors, on as many threads: the same bits at every number of them.
std::unique_ptr<Backend> make_openmp_local_global(const System& system, double dt_s,
                                                  const ExecutionOptions& options);

}  // namespace mssim
