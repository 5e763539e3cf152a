#pragma once

#include <string_view>
#include <vector>

#include "backends/interface/backend.h"

namespace mssim {

/// The harness's own multi-threaded CPU code for cloths and bodies: vectors over bands of a cloth (BandGrid)
/// or over bodies (SlicedBodies, BodyLanes), fused stages, columns or slices distributed over OpenMP threads,
/// bitwise identical for every number of threads. Uses options.instruction_set, or if that is empty the best
/// one with options.roots; for alike bodies a narrower one that needs no more vectors. Throws Unsupported for
/// a garment, for bodies with springs of different materials at a node, and for more nodes than the layout
/// can number, and Unavailable if the instruction set has no code here with options.roots.
BackendMaker make_openmp;

/// make_openmp in double precision: half as many lanes, twice the memory. Roots are always exact, so all
/// instruction sets that fuse multiply-adds (AVX2, AVX-512, NEON) are bitwise identical.
BackendMaker make_openmp_in_double;

/// The instruction sets for which its vector code is compiled and which this CPU supports, by Highway's
/// names, the best first. The order of every sum is the scene's (a column's nodes from the top, a body's
/// neighbours by their number), independent of lanes. So, of those with exact roots (has_exact_roots), all
/// that fuse multiply-adds (AVX2, NEON) are bitwise identical, and so are all that round twice (SSE4, plain
/// floats).
std::vector<std::string_view> openmp_instruction_sets();

/// Whether that instruction set's code computes roots exactly (Roots::exact) instead of from the CPU's
/// estimate.
bool has_exact_roots(std::string_view instruction_set);

}  // namespace mssim
