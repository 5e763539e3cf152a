#pragma once

#include <functional>
#include <memory>

#include "backends/devices/drivers.h"
#include "backends/interface/backend.h"

namespace mssim {

/// Steps a system on an OpenCL device, `lanes` nodes at a time (1, 4, 8 or 16): one fused kernel per stage,
/// or, with several lanes and a cloth, one for all stages of some steps; all are queued in order. Host and
/// device exchange data when a state is set or read and never within a step, so `memory` does not change the
/// time of a step. Calls `before` with the kind of the system before any program is compiled. See the other
/// make_opencl for errors.
std::unique_ptr<Backend> make_opencl(
    const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device, int lanes,
    DeviceMemory memory = DeviceMemory::shared,
    const std::function<void(SteppedKind)>& before = [](SteppedKind) {});

/// Makes the backend on the device that options.device names; if that is a CPU, on options.threads of its
/// compute units. Throws Unavailable if there is no such device or its driver fails, Unsupported if the scene
/// does not fit into its memory, if it has too many nodes or springs, and if springs of different materials
/// meet in a node.
BackendMaker make_opencl;

}  // namespace mssim
