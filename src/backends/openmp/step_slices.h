#pragma once

#include <cstddef>
#include <vector>

#include "backends/openmp/sliced_bodies.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// The vector code for one instruction set.
struct SliceKernel {
  std::size_t lanes;                              ///< floats in a vector: SlicedGraph::lanes must equal it
  const char* instruction_set;                    ///< Highway's name for it
  bool exact_roots;                               ///< as inverse_length (backends/vectors/lanes-inl.h) says
  bool fuses;                                     ///< the same of multiplications and additions
  void (*step)(SlicedBodies& bodies, int count);  ///< takes `count` steps
};

/// The kernels for the instruction sets of this processor that take steps of the integrator, at least one,
/// the best first.
std::vector<SliceKernel> slice_kernels(const Integrator& integrator);

}  // namespace mssim
