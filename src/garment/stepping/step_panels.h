#pragma once

#include <cstdint>
#include <vector>

#include "backends/vectors/instruction_sets.h"
#include "garment/stepping/panel_joints.h"

namespace mssim {

/// The vector code for one instruction set.
struct PanelKernel {
  const char* instruction_set;                       ///< Highway's name for it
  void (*step)(PanelDressing& dressing, int count);  ///< takes `count` steps
};

/// The kernels for the instruction sets of this processor, at least one, the best first.
std::vector<PanelKernel> panel_kernels();

}  // namespace mssim
