#pragma once

#include <functional>
#include <memory>

#include "backends/devices/drivers.h"
#include "backends/interface/backend.h"

namespace mssim {

/// Steps on an OpenCL device, which computes `lanes` springs at a time (1, 4, 8 or 16), and `threads` host
/// threads. Calls `before` with the system's kind before a program is compiled.
std::unique_ptr<Backend> make_hybrid(
    const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device, int threads,
    int lanes, DeviceMemory memory = DeviceMemory::shared,
    const std::function<void(SteppedKind)>& before = [](SteppedKind) {});

/// Hong et al.'s GPU + multi-thread CPU: the OpenCL device that options.device names computes the force of
/// every spring (a CPU: on options.threads of its compute units), and options.threads OpenMP threads sum them
/// at the nodes and integrate. In every stage the nodes go to the device and the forces come back: in shared
/// memory, as published, or by copying (options.memory). Uses System::springs. Throws Unavailable if there is
/// no such device or its driver fails, Unsupported if the scene is too large for it.
std::unique_ptr<Backend> make_hybrid(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options);

}  // namespace mssim
