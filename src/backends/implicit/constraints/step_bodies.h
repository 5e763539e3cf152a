#pragma once

#include <cstddef>
#include <vector>

#include "backends/implicit/constraints/spring_batches.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// The vector code of bodies for one instruction set.
struct BodyConstraintKernel {
  std::size_t lanes;                               ///< floats in a vector: SpringBatches::lanes must equal it
  const char* instruction_set;                     ///< Highway's name for it
  bool exact_roots;                                ///< finds roots as Roots::exact asks
  void (*step)(SpringBatches& bodies, int count);  ///< takes `count` steps
};

/// The kernels for the instruction sets of this processor, at least one, the best first.
std::vector<BodyConstraintKernel> body_constraint_kernels();

}  // namespace mssim
