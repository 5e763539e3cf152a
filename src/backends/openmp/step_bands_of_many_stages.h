#pragma once

#include <cstddef>
#include <vector>

#include "backends/openmp/step_bands.h"

namespace mssim {

/// The most stages of the integrators that step_bands.cpp compiles.
inline constexpr std::size_t few_stages = 2;

/// band_kernels of integrators that have more stages.
std::vector<BandKernel> kernels_of_many_stages();

}  // namespace mssim
