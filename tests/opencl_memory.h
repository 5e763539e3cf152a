#pragma once

#include <utility>
#include <vector>

#include "backends/opencl/device.h"

namespace mssim {

/// The first OpenCL device, as if host memory were no more to it, and a way to use it.
struct DeviceInMemory {
  const char* name;
  OpenclDevice device;
  DeviceMemory memory;
};

/// All that the first OpenCL device can be tested with: every driver can do less than it does.
inline std::vector<DeviceInMemory> ways_to_memory() {
  const OpenclDevice device = choose_opencl_device(opencl_devices(), "");
  std::vector<DeviceInMemory> ways{{"copied", device, DeviceMemory::copy}};
  for (const auto& [name, host_memory] : {std::pair{"the device's own, mapped", HostMemory::none},
                                          {"the host's, mapped", HostMemory::mapped},
                                          {"fine-grained", HostMemory::fine_grained}}) {
    if (host_memory > device.host_memory) break;
    ways.push_back({name, device, DeviceMemory::shared});
    ways.back().device.host_memory = host_memory;
  }
  return ways;
}

}  // namespace mssim
