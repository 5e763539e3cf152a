#pragma once

#include <memory>

#include "backends/interface/backend.h"

namespace mssim {

/// The paper's "CPU only": one thread, an array of nodes, a loop over the spring list that adds to both ends.
/// The baseline: compiled like all timed code, neither tuned nor slowed down.
std::unique_ptr<Backend> make_serial(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options);

/// make_serial in double precision.
std::unique_ptr<Backend> make_serial_in_double(const System& system, const Integrator& integrator,
                                               double dt_s, const ExecutionOptions& options);

/// The paper's "Multi-thread CPU" as published (Hong et al., Figure 5): springs and nodes are split into one
/// group per thread; each thread computes its springs' forces and adds them to the nodes inside a critical
/// section.
std::unique_ptr<Backend> make_threads_mutex(const System& system, const Integrator& integrator, double dt_s,
                                            const ExecutionOptions& options);

}  // namespace mssim
