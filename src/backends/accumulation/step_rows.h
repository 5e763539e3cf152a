#pragma once

#include <cstddef>
#include <vector>

#include "backends/accumulation/padded_rows.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// The vector code for one instruction set.
struct RowKernel {
  std::size_t lanes;                           ///< floats in a vector: PairRows::lanes must equal it
  const char* instruction_set;                 ///< Highway's name for it
  bool exact_roots;                            ///< finds roots as Roots::exact asks
  void (*step)(PaddedRows& cloth, int count);  ///< takes `count` steps
};

/// The kernels for the instruction sets of this processor that take steps of the integrator, at least one,
/// the best first.
std::vector<RowKernel> row_kernels(const Integrator& integrator);

}  // namespace mssim
