#pragma once

#include <CL/cl.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "backends/interface/backend.h"

namespace mssim {

/// The type that a driver states for its device.
enum class OpenclDeviceType : std::uint8_t { cpu, gpu, other };

/// How a device's kernels can use host memory.
enum class HostMemory : std::uint8_t {
  none,         ///< not at all: the device has its own memory
  mapped,       ///< buffers are there, uncopied; the host maps them to read or write
  fine_grained  ///< like mapped, and each sees the other's writes without mapping
};

/// One OpenCL device of this machine.
struct OpenclDevice {
  int number = 0;  ///< index in this list, from 0, for `--device`
  std::string name;
  std::string platform;
  std::string driver_version;
  OpenclDeviceType type = OpenclDeviceType::other;
  std::uint32_t compute_units = 0;
  std::uint64_t global_memory_bytes = 0;
  std::uint64_t max_allocation_bytes = 0;  ///< largest single buffer
  /// Floats in the widest vector that the driver prefers or the device has: Intel's CPU driver prefers single
  /// floats, which it vectorises itself, and is slower with them.
  std::uint32_t float_width = 0;
  HostMemory host_memory = HostMemory::none;
  cl_device_id id = nullptr;
};

/// "cpu", "gpu" or "other".
std::string_view name_of(OpenclDeviceType type);

/// The device that `wanted` names: empty for the first, its number, or in any case a part of its name, its
/// name in tables (device_name) or its platform's. Throws Unavailable if there is none or if several match;
/// the sentence lists the devices.
OpenclDevice choose_opencl_device(std::span<const OpenclDevice> devices, std::string_view wanted);

/// Nodes or springs per work-item that suit the device: wide vectors for a CPU, whose driver does not
/// vectorise, else one.
int lanes_for(const OpenclDevice& device);

/// A part of the device with `count` compute units, if it is this machine's CPU and has more: the driver then
/// runs kernels on that many cores and leaves the others free. The device itself if it is not a CPU, has no
/// more units, or cannot be divided; check compute_units of the result. Repeated calls return the same part.
OpenclDevice part_of(const OpenclDevice& device, int count);

/// Threads of this machine that run a device's kernels, or 1 for the thread that waits for it.
int threads_of(const OpenclDevice& device);

/// Throws Unsupported unless the device can hold buffers of these sizes (bytes) at the same time.
void require_memory(const OpenclDevice& device, std::span<const std::uint64_t> buffer_bytes);

/// One sentence about a failed OpenCL call: the call, the error's name and its number.
std::string opencl_failure(std::string_view call, int error);

}  // namespace mssim
