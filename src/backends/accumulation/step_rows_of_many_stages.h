#pragma once

#include <vector>

#include "backends/accumulation/step_rows.h"

namespace mssim {

/// row_kernels of integrators that have more than two stages.
std::vector<RowKernel> row_kernels_of_many_stages();

}  // namespace mssim
