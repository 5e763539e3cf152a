#pragma once

#include <string>

#include "integrators/integrator.h"

namespace mssim {

/// Text of the program that steps a grid: one kernel per stage of the integrator. With one lane a work-item
/// owns a node (kernels/grid_nodes.cl), with several it walks over columns of bands (kernels/grid_bands.cl).
std::string grid_program_text(const Integrator& integrator, int lanes);

/// Do work-items of such a program walk over columns?
bool grid_program_walks(int lanes);

}  // namespace mssim
