#pragma once

#include <memory>

#include "backends/accumulation/step_rows.h"
#include "backends/interface/backend.h"

namespace mssim {

/// Every node of a cloth sums the forces of its own springs like `gather`, a vector of nodes at a time
/// (padded_rows.h). Beside `openmp`, which has vectors too, it shows what computing each spring once is
/// worth. The instruction set is the best one that has options.roots. Throws Unsupported for anything but a
/// cloth.
std::unique_ptr<Backend> make_gather_vectors(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options);

/// Takes the vector code for another instruction set than the best.
std::unique_ptr<Backend> make_gather_vectors(const System& system, const Integrator& integrator, double dt_s,
                                             const ExecutionOptions& options, const RowKernel& kernel);

}  // namespace mssim
