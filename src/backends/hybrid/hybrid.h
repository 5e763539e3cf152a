#pragma once

#include <functional>
#include <memory>

#include "backends/devices/drivers.h"
#include "backends/interface/backend.h"

namespace mssim {

/// Steps a system on an OpenCL device, which computes `lanes` springs at a time (1, 4, 8 or 16), and
/// `threads` host threads. Calls `before` with the kind of the system before any program is compiled. See the
/// other make_hybrid.
std::unique_ptr<Backend> make_hybrid(
    const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device, int threads,
    int lanes, DeviceMemory memory = DeviceMemory::shared,
    const std::function<void(SteppedKind)>& before = [](SteppedKind) {});

/// Hong et al.'s GPU + multi-thread CPU: the OpenCL device that options.device names computes the force of
/// every spring (a CPU: on options.threads of its compute units), and options.threads OpenMP threads sum them
/// at the nodes and integrate. In every stage the nodes go to the device and the forces come back: in shared
/// memory, as published, or by copying (options.memory). Uses System::springs, whatever the topology. Throws
/// Unavailable if there is no such device or its driver fails, Unsupported if the scene does not fit into its
/// memory or has too many springs.
BackendMaker make_hybrid;

}  // namespace mssim
