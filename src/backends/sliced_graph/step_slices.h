#pragma once

#include <cstddef>

#include "backends/sliced_graph/sliced_bodies.h"

namespace mssim {

/// The vector code for one instruction set.
struct SliceKernel {
  std::size_t lanes;                              ///< floats in a vector: SlicedGraph::lanes must equal it
  const char* instruction_set;                    ///< Highway's name for it
  void (*step)(SlicedBodies& bodies, int count);  ///< takes `count` steps
};

/// The kernel for the best instruction set of this processor.
SliceKernel best_slice_kernel();

}  // namespace mssim
