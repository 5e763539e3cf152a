#pragma once

#include "backends/devices/device.h"
#include "backends/devices/drivers.h"
#include "backends/hybrid/hybrid.h"
#include "backends/opencl/opencl.h"
#include "tests/support/testing.h"

namespace mssim {

/// The widths that tests build kernels for. On ARM, whose vectors hold four floats, wider ones are not run by
/// any backend, and take an emulator a quarter of an hour to compile.
#if defined(__aarch64__)
inline constexpr std::array opencl_lanes{1, 4};
#else
inline constexpr std::array opencl_lanes{1, 4, 8, 16};
#endif
inline constexpr int most_opencl_lanes = opencl_lanes.back();

/// The device that a backend takes where the user names none.
inline OpenclDevice first_opencl_device() { return choose_opencl_device(opencl_offer().devices, ""); }

/// The first OpenCL device, as if host memory were no more to it, and a variant to use it.
struct DeviceInMemory {
  const char* name;
  OpenclDevice device;
  DeviceMemory memory;
};

/// All that the first OpenCL device can be tested with: every driver can do less than it does.
inline std::vector<DeviceInMemory> ways_to_memory() {
  const OpenclDevice device = first_opencl_device();
  std::vector<DeviceInMemory> variants{{"copied", device, DeviceMemory::copy}};
  for (const auto& [name, host_memory] : {std::pair{"the device's own, mapped", HostMemory::none},
                                          {"the host's, mapped", HostMemory::mapped},
                                          {"fine-grained", HostMemory::fine_grained}}) {
    if (host_memory > device.host_memory) break;
    variants.push_back({name, device, DeviceMemory::shared});
    variants.back().device.host_memory = host_memory;
  }
  return variants;
}

/// A backend that uses the first OpenCL device, in one variant of running it.
struct OpenclVariant {
  bool hybrid;
  int lanes;        ///< 1 is what a GPU runs
  int threads = 2;  ///< hybrid's

  std::unique_ptr<Backend> make(const System& system, const Integrator& integrator, double dt_s) const {
    return make_in({"", first_opencl_device(), DeviceMemory::shared}, system, integrator, dt_s);
  }
  std::unique_ptr<Backend> make_in(const DeviceInMemory& memory, const System& system,
                                   const Integrator& integrator, double dt_s) const {
    return hybrid ? make_hybrid(system, integrator, dt_s, memory.device, threads, lanes, memory.memory)
                  : make_opencl(system, integrator, dt_s, memory.device, lanes, memory.memory);
  }
  std::string name() const {
    return hybrid ? "hybrid, " + std::to_string(lanes) + " lanes, " + std::to_string(threads) + " threads"
                  : "opencl, " + std::to_string(lanes) + " lanes";
  }
};

}  // namespace mssim
