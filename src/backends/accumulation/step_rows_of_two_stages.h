#pragma once

#include <vector>

#include "backends/accumulation/step_rows.h"

namespace mssim {

/// row_kernels of integrators that have two stages.
std::vector<RowKernel> row_kernels_of_two_stages();

}  // namespace mssim
