#pragma once

#include <memory>

#include "backends/backend.h"

namespace mssim {

/// The harness's own multi-threaded CPU code: vectors over bands of the cloth (grid_bands/band_sheet.h),
/// fused stages, columns split over OpenMP threads, the same bits for every number of threads.
std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options);

}  // namespace mssim
