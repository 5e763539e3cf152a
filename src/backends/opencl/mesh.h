#pragma once

#include <memory>

#include "backends/devices/device.h"
#include "backends/interface/backend.h"

namespace mssim {

/// Steps tetrahedral bodies on an OpenCL device from their sliced graph, `lanes` nodes side by side (1, 4, 8
/// or 16). Lets cl::Error through; throws Unsupported where they do not fit into the device's memory or one
/// node has springs of unlike materials.
std::unique_ptr<Backend> make_opencl_mesh(const System& system, const Integrator& integrator, double dt_s,
                                          const OpenclDevice& device, DeviceMemory memory, int lanes);

}  // namespace mssim
