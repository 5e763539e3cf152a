#pragma once

#include <cstddef>
#include <vector>

#include "backends/implicit/newton/vector_equation.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// The vector code for one instruction set. Each takes `count` steps.
struct NewtonKernel {
  std::size_t lanes;            ///< floats in a vector: that of the nodes must equal it
  const char* instruction_set;  ///< Highway's name for it
  bool exact_roots;             ///< as inverse_length (backends/vectors/lanes-inl.h) says
  void (*step_cloth)(VectorEquation<NodeRows>& equation, int count);
  void (*step_bodies)(VectorEquation<NodeSlices>& equation, int count);
};

/// The kernels for the instruction sets of this processor, at least one, the best first.
std::vector<NewtonKernel> newton_kernels();

}  // namespace mssim
