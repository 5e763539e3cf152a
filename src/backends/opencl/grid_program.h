#pragma once

#include <string>

#include "integrators/integrator.h"

namespace mssim {

/// Text of the program that steps a grid: with one lane a kernel per stage of the integrator, where a
/// work-item owns a node (kernels/grid_nodes.cl); with several one kernel that takes steps, where a work-item
/// walks over columns of bands (kernels/grid_bands.cl).
std::string grid_program_text(const Integrator& integrator, int lanes);

/// Do work-items of such a program walk over columns?
bool grid_program_walks(int lanes);

/// Name of the kernel that takes steps in a walk.
std::string steps_kernel_name();

}  // namespace mssim
