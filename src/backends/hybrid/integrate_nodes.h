#pragma once

#include <vector>

#include "backends/hybrid/host_nodes.h"
#include "backends/hybrid/mapped_nodes.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// The kernels that this processor can run, the best first.
std::vector<NodeKernel<HostNodes>> node_kernels();

}  // namespace mssim
