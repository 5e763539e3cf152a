#pragma once

#include <cstddef>
#include <vector>

#include "backends/implicit/constraints/quartered_rows.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// The vector code of cloths for one instruction set.
struct ClothConstraintKernel {
  std::size_t lanes;                              ///< floats in a vector: QuarterLayout::lanes must equal it
  const char* instruction_set;                    ///< Highway's name for it
  bool exact_roots;                               ///< finds roots as Roots::exact asks
  void (*step)(QuarteredRows& cloth, int count);  ///< takes `count` steps
};

/// The kernels for the instruction sets of this processor, at least one, the best first.
std::vector<ClothConstraintKernel> cloth_constraint_kernels();

}  // namespace mssim
