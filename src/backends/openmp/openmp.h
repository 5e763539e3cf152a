#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "backends/interface/backend.h"

namespace mssim {

/// The harness's own multi-threaded CPU code for cloths and bodies: vectors over bands of a cloth (BandGrid)
/// or over bodies (SlicedBodies, BodyLanes), fused stages, columns or slices split over OpenMP threads, the
/// same bits for every number of threads. The instruction set is the best one that has options.roots; of
/// alike bodies a narrower one that needs no more vectors. Throws Unsupported for a garment, for bodies in
/// whose nodes springs of different materials meet, and for more nodes than the layout numbers.
std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options);

/// The instruction sets that its vector code is compiled for and this processor has, by Highway's names, the
/// best first. The order of every sum is the scene's (a column's nodes from the top,
/// a body's neighbours by their number) and has nothing to do with lanes. So of those that have exact roots
/// (has_exact_roots) all that fuse a multiplication and an addition (AVX2, NEON) give the same bits, and all
/// that round twice (SSE4, plain floats) give the same bits.
std::vector<std::string_view> openmp_instruction_sets();

/// Whether that instruction set's code finds roots exactly (Roots::exact), and not from the processor's
/// estimate.
bool has_exact_roots(std::string_view instruction_set);

/// make_openmp with the vector code for this one of those instruction sets, however wide. Throws
/// std::invalid_argument for one that is not among them.
std::unique_ptr<Backend> make_openmp(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options, std::string_view instruction_set);

}  // namespace mssim
