#pragma once

#include <cstddef>
#include <vector>

#include "backends/layouts/band_grid.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// The vector code for one instruction set.
struct BandKernel {
  std::size_t lanes;                         ///< floats in a vector: BandLayout::lanes must equal it
  const char* instruction_set;               ///< Highway's name for it
  bool exact_roots;                          ///< as inverse_length (backends/vectors/lanes-inl.h) says
  bool fuses;                                ///< the same of multiplications and additions
  void (*step)(BandGrid& bands, int count);  ///< takes `count` steps
};

/// The kernels for the instruction sets of this processor that take steps of the integrator, at least one,
/// the best first.
std::vector<BandKernel> band_kernels(const Integrator& integrator);

}  // namespace mssim
