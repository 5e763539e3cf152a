#pragma once

#include <cstddef>
#include <string>

#include "integrators/integrator.h"
#include "kernels/mesh_parameters.h"

namespace mssim {

/// Text of the program that steps a sliced graph: one kernel per stage of the integrator, over
/// kernels/mesh_stage.cl.
std::string mesh_program_text(const Integrator& integrator, int lanes);

/// Nodes in a slice of the graph that the program reads.
std::size_t mesh_slice_lanes(int lanes);

/// The program for alike bodies, over kernels/alike_stage.cl, and the bodies in a slice of them.
std::string alike_program_text(const Integrator& integrator, int lanes);
std::size_t alike_slice_lanes(int lanes);

}  // namespace mssim
