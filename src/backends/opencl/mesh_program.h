#pragma once

#include <cstddef>
#include <string>

#include "integrators/integrator.h"

namespace mssim {

/// Text of the program that steps a sliced graph: one kernel per stage of the integrator, over
/// kernels/mesh_stage.cl.
std::string mesh_program_text(const Integrator& integrator, int lanes);

/// Nodes in a slice of the graph that the program reads.
std::size_t mesh_slice_lanes(int lanes);

}  // namespace mssim
