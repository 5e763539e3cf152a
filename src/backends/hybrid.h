#pragma once

#include <memory>

#include "backends/backend.h"

namespace mssim {

/// Hong et al.'s GPU + multi-thread CPU: the OpenCL device that options.device names computes the force of
/// every spring into memory shared with the host, options.threads OpenMP threads sum them at the nodes and
/// integrate. Works from System::springs, whatever the topology. Throws Unavailable where there is no such
/// device or its driver fails, Unsupported where the scene does not fit into its memory.
std::unique_ptr<Backend> make_hybrid(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options);

}  // namespace mssim
