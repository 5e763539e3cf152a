#pragma once

#include <functional>
#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// The integrator in double precision on one thread, at the system's start: the reference that every timed
/// row is verified against. Solvers of implicit integrators go on until they gain nothing more; where a step
/// of them may take long, it ends when `stop` says so, and the state is then of no use. `system` must outlive
/// it. Throws Unsupported for a garment.
std::unique_ptr<Backend> make_reference(const System& system, const Integrator& integrator, double dt_s,
                                        const std::function<bool()>& stop = {});

/// What it takes for a cloth (`grid`) or bodies.
MemoryUse reference_memory(const Integrator& integrator, bool grid);

}  // namespace mssim
