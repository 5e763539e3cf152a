#pragma once

#include <vector>

#include "backends/openmp/step_bands.h"

namespace mssim {

/// band_kernels of integrators that have more than two stages.
std::vector<BandKernel> band_kernels_of_many_stages();

}  // namespace mssim
