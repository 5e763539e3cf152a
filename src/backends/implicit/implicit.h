#pragma once

#include <functional>
#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// Steps of the TABLE of implicit integrators (integrators/all_integrators.h), for cloths and bodies. After
/// each step the floor acts as it does behind the stages of explicit ones. Each throws Unsupported for a
/// garment, and std::invalid_argument for an explicit integrator; `system` must outlive what it returns.

/// On one thread, by plain loops over the spring list in single precision: the baseline.
std::unique_ptr<Backend> make_serial_implicit(const System& system, const Integrator& integrator, double dt_s,
                                              const ExecutionOptions& options);

/// The plain code in double precision, whose solvers go on until they gain nothing more, or `stop` says that
/// nobody waits for them any longer (make_reference in backends/backends.h).
std::unique_ptr<Backend> make_implicit_reference(const System& system, const Integrator& integrator,
                                                 double dt_s, const std::function<bool()>& stop);

/// With vectors and options.threads threads: the same bits at every number of threads.
std::unique_ptr<Backend> make_openmp_implicit(const System& system, const Integrator& integrator, double dt_s,
                                              const ExecutionOptions& options);

/// What they take for a cloth (`grid`) or for bodies.
MemoryUse serial_implicit_memory(const Integrator& integrator, bool grid);
MemoryUse implicit_reference_memory(const Integrator& integrator, bool grid);
MemoryUse openmp_implicit_memory(const Integrator& integrator, bool grid);

}  // namespace mssim
