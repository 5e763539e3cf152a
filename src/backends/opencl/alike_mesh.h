#pragma once

#include <memory>
#include <vector>

#include "backends/devices/device.h"
#include "backends/interface/backend.h"
#include "backends/layouts/alike_bodies.h"

namespace mssim {

/// Steps alike bodies on an OpenCL device, `lanes` of them side by side (1, 4, 8 or 16), to the bits of
/// make_opencl_mesh. `bodies`: all of the system. Lets cl::Error through; throws Unsupported where they do
/// not fit into the device's memory or have too many nodes or springs.
std::unique_ptr<Backend> make_opencl_alike_mesh(const System& system, const std::vector<AlikeBodies>& bodies,
                                                const Integrator& integrator, double dt_s,
                                                const OpenclDevice& device, DeviceMemory memory, int lanes);

}  // namespace mssim
