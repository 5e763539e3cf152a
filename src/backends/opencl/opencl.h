#pragma once

#include <functional>
#include <memory>

#include "backends/devices/drivers.h"
#include "backends/interface/backend.h"

namespace mssim {

/// Steps a system on an OpenCL device, `lanes` nodes side by side (1, 4, 8 or 16): one fused kernel per
/// stage, or with several lanes and a cloth one for all stages of some steps; all are queued in order. Host
/// and device exchange data when a state is set or read and never within a step, whose time `memory`
/// therefore does not change. `before` is told of what kind the system is before any program is compiled. See
/// the other make_opencl for errors.
std::unique_ptr<Backend> make_opencl(
    const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device, int lanes,
    DeviceMemory memory = DeviceMemory::shared,
    const std::function<void(SteppedKind)>& before = [](SteppedKind) {});

/// Makes the backend on the device that options.device names, and where that is a processor on
/// options.threads of its compute units. Throws Unavailable where there is no such device or its driver
/// fails, Unsupported where the scene does not fit into its memory, where it has too many nodes or springs,
/// and where springs of unlike materials meet in a node.
std::unique_ptr<Backend> make_opencl(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options);

}  // namespace mssim
