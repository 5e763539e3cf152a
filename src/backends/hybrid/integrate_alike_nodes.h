#pragma once

#include <vector>

#include "backends/hybrid/alike_nodes.h"
#include "backends/hybrid/mapped_nodes.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// The kernels that this processor can run, the best first.
std::vector<NodeKernel<AlikeNodes>> alike_node_kernels();

}  // namespace mssim
