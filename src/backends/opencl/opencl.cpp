#include "backends/opencl/opencl.h"

#include "backends/devices/call.h"
#include "backends/devices/driver_trial.h"
#include "backends/devices/offer.h"
#include "backends/devices/sub_device.h"
#include "backends/opencl/alike_mesh.h"
#include "backends/opencl/grid.h"
#include "backends/opencl/mesh.h"
#include "backends/opencl/mesh_program.h"

namespace mssim {

namespace {

/// `before`: is told of what kind the system is before any program is compiled.
template <class Before>
std::unique_ptr<Backend> make(const System& system, const Integrator& integrator, double dt_s,
                              const OpenclDevice& device, int lanes, DeviceMemory memory,
                              const Before& before) {
  return opencl_call<Unavailable>([&]() -> std::unique_ptr<Backend> {
    if (const auto* grid = std::get_if<GridPatch>(&system.topology)) {
      before(SteppedKind::cloth);
      return make_opencl_grid(system, *grid, integrator, dt_s, device, memory, lanes);
    }
    // With thirteen bodies in sixteen lanes a step takes 0.61 of the time that a sliced graph takes (PoCL on
    // an Intel Xeon): so it is worth it from nine on.
    constexpr double lanes_per_body = 1.8;
    const auto alike = alike_bodies_for(system, alike_slice_lanes(lanes), lanes_per_body);
    before(alike ? SteppedKind::alike_bodies : SteppedKind::bodies);
    if (alike) return make_opencl_alike_mesh(system, *alike, integrator, dt_s, device, memory, lanes);
    return make_opencl_mesh(system, integrator, dt_s, device, memory, lanes);
  });
}

}  // namespace

std::unique_ptr<Backend> make_opencl(const System& system, const Integrator& integrator, double dt_s,
                                     const OpenclDevice& device, int lanes, DeviceMemory memory) {
  return make(system, integrator, dt_s, device, lanes, memory, [](SteppedKind) {});
}

std::unique_ptr<Backend> make_opencl(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  const OpenclDevice device = part_of(find_opencl_device(options.device), options.threads);
  return make(system, integrator, dt_s, device, lanes_for(device), options.memory, [&](SteppedKind kind) {
    try_driver({"opencl", std::string(integrator.name), kind, options}, device);
  });
}

}  // namespace mssim
