#include "backends/devices/device.h"

#include <CL/cl_ext.h>

#include <CL/opencl.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "platform/machine.h"
#include "text/text.h"

namespace mssim {
namespace {

std::string listing(std::span<const OpenclDevice> devices) {
  const auto shown = [](const OpenclDevice& device) {
    return fmt::format("{} ({}, {})", device.number, device.name, device.platform);
  };
  return join(mapped<std::string>(devices, shown), ", ");
}

struct ErrorName {
  int code;
  std::string_view name;
};
#define MSSIM_NAME(code) \
  ErrorName { code, #code }
constexpr std::array error_names{
    MSSIM_NAME(CL_DEVICE_NOT_FOUND),
    MSSIM_NAME(CL_DEVICE_NOT_AVAILABLE),
    MSSIM_NAME(CL_COMPILER_NOT_AVAILABLE),
    MSSIM_NAME(CL_MEM_OBJECT_ALLOCATION_FAILURE),
    MSSIM_NAME(CL_OUT_OF_RESOURCES),
    MSSIM_NAME(CL_OUT_OF_HOST_MEMORY),
    MSSIM_NAME(CL_PROFILING_INFO_NOT_AVAILABLE),
    MSSIM_NAME(CL_MEM_COPY_OVERLAP),
    MSSIM_NAME(CL_BUILD_PROGRAM_FAILURE),
    MSSIM_NAME(CL_MAP_FAILURE),
    MSSIM_NAME(CL_MISALIGNED_SUB_BUFFER_OFFSET),
    MSSIM_NAME(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST),
    MSSIM_NAME(CL_COMPILE_PROGRAM_FAILURE),
    MSSIM_NAME(CL_LINKER_NOT_AVAILABLE),
    MSSIM_NAME(CL_LINK_PROGRAM_FAILURE),
    MSSIM_NAME(CL_INVALID_VALUE),
    MSSIM_NAME(CL_INVALID_DEVICE_TYPE),
    MSSIM_NAME(CL_INVALID_PLATFORM),
    MSSIM_NAME(CL_INVALID_DEVICE),
    MSSIM_NAME(CL_INVALID_CONTEXT),
    MSSIM_NAME(CL_INVALID_QUEUE_PROPERTIES),
    MSSIM_NAME(CL_INVALID_COMMAND_QUEUE),
    MSSIM_NAME(CL_INVALID_HOST_PTR),
    MSSIM_NAME(CL_INVALID_MEM_OBJECT),
    MSSIM_NAME(CL_INVALID_BINARY),
    MSSIM_NAME(CL_INVALID_BUILD_OPTIONS),
    MSSIM_NAME(CL_INVALID_PROGRAM),
    MSSIM_NAME(CL_INVALID_PROGRAM_EXECUTABLE),
    MSSIM_NAME(CL_INVALID_KERNEL_NAME),
    MSSIM_NAME(CL_INVALID_KERNEL_DEFINITION),
    MSSIM_NAME(CL_INVALID_KERNEL),
    MSSIM_NAME(CL_INVALID_ARG_INDEX),
    MSSIM_NAME(CL_INVALID_ARG_VALUE),
    MSSIM_NAME(CL_INVALID_ARG_SIZE),
    MSSIM_NAME(CL_INVALID_KERNEL_ARGS),
    MSSIM_NAME(CL_INVALID_WORK_DIMENSION),
    MSSIM_NAME(CL_INVALID_WORK_GROUP_SIZE),
    MSSIM_NAME(CL_INVALID_WORK_ITEM_SIZE),
    MSSIM_NAME(CL_INVALID_GLOBAL_OFFSET),
    MSSIM_NAME(CL_INVALID_EVENT_WAIT_LIST),
    MSSIM_NAME(CL_INVALID_EVENT),
    MSSIM_NAME(CL_INVALID_OPERATION),
    MSSIM_NAME(CL_INVALID_BUFFER_SIZE),
    MSSIM_NAME(CL_INVALID_GLOBAL_WORK_SIZE),
    MSSIM_NAME(CL_INVALID_PROPERTY),
    MSSIM_NAME(CL_INVALID_COMPILER_OPTIONS),
    MSSIM_NAME(CL_INVALID_LINKER_OPTIONS),
    MSSIM_NAME(CL_PLATFORM_NOT_FOUND_KHR),
};
#undef MSSIM_NAME

using Property = cl_device_partition_property;

/// Properties that request a part of `count` compute units from the driver, in the most specific way; nothing
/// if the driver supports none.
std::optional<std::vector<Property>> request_for(const cl::Device& device, int count) {
  const std::vector<Property> properties = device.getInfo<CL_DEVICE_PARTITION_PROPERTIES>();
  const auto offers = [&](Property property) {
    return std::ranges::find(properties, property) != properties.end();
  };
  if (offers(CL_DEVICE_PARTITION_BY_COUNTS))
    return std::vector<Property>{CL_DEVICE_PARTITION_BY_COUNTS, count, CL_DEVICE_PARTITION_BY_COUNTS_LIST_END,
                                 0};
  if (offers(CL_DEVICE_PARTITION_EQUALLY))
    return std::vector<Property>{CL_DEVICE_PARTITION_EQUALLY, count, 0};
  return std::nullopt;
}

/// The part, or nothing if the driver cannot make it.
std::optional<cl::Device> make_part(cl::Device device, int count) {
  try {
    const auto request = request_for(device, count);
    std::vector<cl::Device> parts;
    if (request) device.createSubDevices(request->data(), &parts);
    if (!parts.empty()) return parts.front();
  } catch (const cl::Error&) {
    // Drivers without support for this kind of part report an error.
  }
  return std::nullopt;
}

}  // namespace

std::string_view name_of(OpenclDeviceType type) {
  constexpr std::array<std::string_view, 3> names{"cpu", "gpu", "other"};
  return names.at(static_cast<std::size_t>(type));
}

OpenclDevice choose_opencl_device(std::span<const OpenclDevice> devices, std::string_view wanted) {
  if (devices.empty())
    throw Unavailable(
        "no OpenCL device on this machine: install a driver, for example Debian's pocl-opencl-icd for the "
        "CPU");
  if (wanted.empty()) return devices.front();

  if (std::all_of(wanted.begin(), wanted.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) {
    for (const OpenclDevice& device : devices)
      if (std::to_string(device.number) == wanted) return device;
    throw Unavailable("no OpenCL device has the number {}; there are: {}", wanted, listing(devices));
  }

  const auto has_it = [part = to_lower(wanted)](const std::string& text) {
    return to_lower(text).find(part) != std::string::npos;
  };
  std::vector<OpenclDevice> fitting;
  for (const OpenclDevice& device : devices)
    if (has_it(device.name) || has_it(device_name(device.name)) || has_it(device.platform))
      fitting.push_back(device);
  if (fitting.empty())
    throw Unavailable("no OpenCL device has \"{}\" in its name or its platform's; there are: {}", wanted,
                      listing(devices));
  if (fitting.size() > 1)
    throw Unavailable("several OpenCL devices have \"" + std::string(wanted) +
                      "\" in their names or platforms, choose one by its number: " + listing(fitting));
  return fitting.front();
}

int lanes_for(const OpenclDevice& device) {
  if (device.type != OpenclDeviceType::cpu) return 1;
  int lanes = 4;
  while (lanes < 16 && static_cast<std::uint32_t>(lanes) < device.float_width) lanes *= 2;
  return lanes;
}

OpenclDevice part_of(const OpenclDevice& device, int count) {
  if (device.type != OpenclDeviceType::cpu || device.compute_units <= static_cast<std::uint32_t>(count))
    return device;
  // Never released: a driver may be unloaded before a destructor would release them.
  static std::map<std::pair<cl_device_id, int>, OpenclDevice> parts;
  const auto [known, is_new] = parts.try_emplace({device.id, count}, device);
  if (is_new)
    if (const auto part = make_part(cl::Device(device.id, true), count)) {
      clRetainDevice((*part)());
      known->second.id = (*part)();
      known->second.compute_units = part->getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    }
  return known->second;
}

int threads_of(const OpenclDevice& device) {
  if (device.type != OpenclDeviceType::cpu) return 1;
  // Some drivers have more compute units than there are CPUs for their threads.
  static const std::size_t processors = process_cpus().size();
  const auto units = static_cast<int>(device.compute_units);
  return processors == 0 ? units : std::min(units, static_cast<int>(processors));
}

void require_memory(const OpenclDevice& device, std::span<const std::uint64_t> buffer_bytes) {
  const auto megabytes = [](std::uint64_t bytes) { return fmt::format("{} MiB", (bytes >> 20) + 1); };
  std::uint64_t largest = 0, all = 0;
  for (const std::uint64_t bytes : buffer_bytes) {
    largest = std::max(largest, bytes);
    all += bytes;
  }
  if (largest > device.max_allocation_bytes)
    throw Unsupported("the scene needs an OpenCL buffer of {}, {} allocates at most {} in one piece",
                      megabytes(largest), device.name, megabytes(device.max_allocation_bytes));
  if (all > device.global_memory_bytes)
    throw Unsupported("the scene needs {} of OpenCL buffers, {} has {} in all", megabytes(all), device.name,
                      megabytes(device.global_memory_bytes));
}

std::string opencl_failure(std::string_view call, int error) {
  const ErrorName* known = found_in(error_names, error, &ErrorName::code);
  return fmt::format("the OpenCL call {} failed with {} ({})", call,
                     known ? known->name : std::string_view("an unknown error"), error);
}

}  // namespace mssim
