#pragma once

#include <memory>

#include "backends/devices/device.h"
#include "backends/interface/backend.h"

namespace mssim {

/// Steps a cloth on an OpenCL device, `lanes` nodes side by side (1, 4, 8 or 16). Lets cl::Error through;
/// throws Unsupported where the cloth does not fit into the device's memory.
std::unique_ptr<Backend> make_opencl_grid(const System& system, const GridPatch& grid,
                                          const Integrator& integrator, double dt_s,
                                          const OpenclDevice& device, DeviceMemory memory, int lanes);

}  // namespace mssim
