#pragma once

#include <cstddef>
#include <string>

#include "backends/grid_bands/band_sheet.h"

namespace mssim {

/// The vector code for one instruction set.
struct BandKernel {
  std::size_t lanes;                          ///< floats in a vector: BandLayout::lanes must equal it
  const char* instruction_set;                ///< Highway's name for it
  void (*step)(BandSheet& sheet, int count);  ///< takes `count` steps
};

/// The kernel for the best instruction set of this processor.
BandKernel best_band_kernel();

}  // namespace mssim
