#pragma once

#include <functional>
#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// Backends for the TABLE of implicit integrators (integrators/all_integrators.h), for cloths and bodies.
/// After each step the floor acts as after the stages of explicit ones. Each function throws Unsupported for
/// a garment, and std::invalid_argument for an explicit integrator; `system` must outlive the backend.

/// On one thread, with plain loops over the spring list in single precision: the baseline.
BackendMaker make_serial_implicit;

/// The plain code in double precision, whose solvers iterate until they improve no more, or until `stop`
/// returns true (make_reference in backends/backends.h).
std::unique_ptr<Backend> make_implicit_reference(const System& system, const Integrator& integrator,
                                                 double dt_s, const std::function<bool()>& stop);

/// With vectors and options.threads threads: bitwise identical for every number of threads.
BackendMaker make_openmp_implicit;

/// Their memory for a cloth (`grid`) or for bodies.
MemoryUse serial_implicit_memory(const Integrator& integrator, bool grid);
MemoryUse implicit_reference_memory(const Integrator& integrator, bool grid);
MemoryUse openmp_implicit_memory(const Integrator& integrator, bool grid);

}  // namespace mssim
