#pragma once

#include <memory>
#include <optional>

#include "backends/devices/device.h"
#include "backends/interface/backend.h"

namespace mssim {

/// Steps a cloth on an OpenCL device whose work-items walk over columns of `lanes` bands of rows (4, 8 or
/// 16), several steps a launch. `steps_in_a_launch`: chosen by the size of the cloth unless given. Lets
/// cl::Error through; throws Unsupported where the cloth does not fit into the device's memory.
std::unique_ptr<Backend> make_opencl_bands(const System& system, const GridPatch& grid,
                                           const Integrator& integrator, double dt_s,
                                           const OpenclDevice& device, DeviceMemory memory, int lanes,
                                           std::optional<std::size_t> steps_in_a_launch = {});

}  // namespace mssim
