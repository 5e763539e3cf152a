#pragma once

#include <cstddef>
#include <vector>

#include "backends/openmp/body_lanes.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// The vector code for one instruction set.
struct BodyLanesKernel {
  std::size_t lanes;                           ///< floats in a vector: AlikeSlices::lanes must equal it
  const char* instruction_set;                 ///< Highway's name for it
  bool exact_roots;                            ///< as inverse_length (backends/vectors/lanes-inl.h) says
  void (*step)(BodyLanes& bodies, int count);  ///< takes `count` steps
};

/// The kernels for the instruction sets of this processor, at least one, the best first.
std::vector<BodyLanesKernel> body_lanes_kernels();

}  // namespace mssim
