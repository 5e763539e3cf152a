#pragma once

#include <CL/cl.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "backends/interface/backend.h"

namespace mssim {

enum class OpenclDeviceType : std::uint8_t { cpu, gpu, other };

/// What host memory can be to a device's kernels.
enum class HostMemory : std::uint8_t {
  none,         ///< nothing: the device has memory of its own
  mapped,       ///< buffers lie there without being copied; the host maps them to read or write
  fine_grained  ///< the same, and each sees what the other wrote without mapping
};

/// One OpenCL device of this machine.
struct OpenclDevice {
  int number = 0;  ///< in this list, from 0; what `--device` takes
  std::string name;
  std::string platform;
  std::string driver_version;
  OpenclDeviceType type = OpenclDeviceType::other;
  std::uint32_t compute_units = 0;
  std::uint64_t global_memory_bytes = 0;
  std::uint64_t max_allocation_bytes = 0;  ///< largest single buffer
  /// Floats in the widest vector that the driver prefers or the device has: Intel's driver for processors
  /// prefers single floats, which it packs by itself, and is slower with them.
  std::uint32_t float_width = 0;
  HostMemory host_memory = HostMemory::none;
  cl_device_id id = nullptr;
};

/// "cpu", "gpu" or "other".
std::string_view name_of(OpenclDeviceType type);

/// The device that `wanted` names: empty for the first, its number, or a part of its name or its platform's
/// in any case.
/// Throws Unavailable when there is none or when the part fits several; the sentence lists what there is.
OpenclDevice choose_opencl_device(std::span<const OpenclDevice> devices, std::string_view wanted);

/// Nodes or springs per work-item that suit the device: wide vectors for a CPU, whose driver packs nothing by
/// itself, one for everything else.
int lanes_for(const OpenclDevice& device);

/// A part of the device that has `count` compute units, where it is this machine's processor and has more:
/// the driver then runs kernels on so many processors and leaves the others alone. The device itself where it
/// is no processor, has no more, or its driver cannot divide it; compute_units of what is returned is the
/// truth. The same part whenever it is asked for.
OpenclDevice part_of(const OpenclDevice& device, int count);

/// Processors of this machine that run a device's kernels, or one thread that waits for it.
int threads_of(const OpenclDevice& device);

/// Throws Unsupported unless the device can hold buffers of these many bytes all at once.
void require_memory(const OpenclDevice& device, std::span<const std::uint64_t> buffer_bytes);

/// One sentence about a failed OpenCL call: the call, the error's name and its number.
std::string opencl_failure(std::string_view call, int error);

}  // namespace mssim
