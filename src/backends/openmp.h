#pragma once

#include <memory>

#include "backends/backend.h"

namespace mssim {

/// The harness's own multi-threaded CPU code: vectors over bands of a cloth (grid_bands/band_sheet.h) or over
/// slices of bodies (sliced_graph/sliced_bodies.h), fused stages, columns or slices split over OpenMP
/// threads, the same bits for every number of threads. Throws Unsupported for bodies in whose nodes springs
/// of different materials meet.
std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options);

}  // namespace mssim
