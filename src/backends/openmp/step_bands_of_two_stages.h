#pragma once

#include <vector>

#include "backends/openmp/step_bands.h"

namespace mssim {

/// band_kernels of integrators that have two stages.
std::vector<BandKernel> band_kernels_of_two_stages();

}  // namespace mssim
