#pragma once

#include <vector>

#include "backends/openmp/step_slices.h"

namespace mssim {

/// slice_kernels of integrators that have more than one stage.
std::vector<SliceKernel> slice_kernels_of_many_stages();

}  // namespace mssim
