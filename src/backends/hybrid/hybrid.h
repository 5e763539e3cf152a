#pragma once

#include <functional>
#include <memory>

#include "backends/devices/drivers.h"
#include "backends/interface/backend.h"

namespace mssim {

/// Steps a system on an OpenCL device, which takes `lanes` springs side by side (1, 4, 8 or 16), and
/// `threads` host threads. `before` is told of what kind the system is before any program is compiled. See
/// the other make_hybrid.
std::unique_ptr<Backend> make_hybrid(
    const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device, int threads,
    int lanes, DeviceMemory memory = DeviceMemory::shared,
    const std::function<void(SteppedKind)>& before = [](SteppedKind) {});

/// Hong et al.'s GPU + multi-thread CPU: the OpenCL device that options.device names computes the force of
/// every spring (where it is a processor, on options.threads of its compute units), options.threads OpenMP
/// threads sum them at the nodes and integrate. In every stage the nodes go to the device and the forces come
/// back: in shared memory, as published, or by copying (options.memory). Works from System::springs, whatever
/// the topology. Throws Unavailable where there is no such device or its driver fails, Unsupported where the
/// scene does not fit into its memory or has too many springs.
std::unique_ptr<Backend> make_hybrid(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options);

}  // namespace mssim
