#pragma once

#include <functional>
#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// implicit-euler and newton-euler (integrators/all_integrators.h). `system` is no garment and outlives the
/// backend.

/// By plain loops over the spring list on one thread.
std::unique_ptr<Backend> make_serial_newton(const System& system, const Integrator& integrator, double dt_s);

/// Newton's method in double precision, until nothing more is gained. Where `stop`, which is asked often in a
/// step, says so, the step ends there; the state is then of no use.
std::unique_ptr<Backend> make_newton_reference(const System& system, const Integrator& integrator,
                                               double dt_s, const std::function<bool()>& stop = {});

/// With vectors, on as many threads: the same bits at every number of them.
std::unique_ptr<Backend> make_openmp_newton(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options);

}  // namespace mssim
