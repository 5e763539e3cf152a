#pragma once

#include <cstddef>

#include "backends/implicit/nodes/node_rows.h"
#include "backends/implicit/nodes/node_slices.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// acceleration_at() at all nodes, for one instruction set. The fields are Nodes::field_floats() long.
struct AccelerationKernel {
  std::size_t lanes;
  const char* instruction_set;
  void (*of_rows)(const NodeRows& nodes, const float* x, const float* v, float* acceleration);
  void (*of_slices)(const NodeSlices& nodes, const float* x, const float* v, float* acceleration);
};

/// Those of this processor.
std::vector<AccelerationKernel> acceleration_kernels();

}  // namespace mssim
