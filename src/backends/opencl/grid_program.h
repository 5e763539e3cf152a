#pragma once

#include <string>

#include "integrators/integrator.h"

namespace mssim {

/// Text of the program that steps a grid: one kernel per stage of the integrator, over kernels/grid_stage.cl
/// and the stencil.
std::string grid_program_text(const Integrator& integrator, int lanes);

/// Does a work-item of the program walk over a block of rows, with one row of work-items and `sums` as the
/// last argument, or own one node? kernels/grid_stage.cl says how.
bool grid_program_walks(int lanes);

}  // namespace mssim
