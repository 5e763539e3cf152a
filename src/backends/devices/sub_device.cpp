#include "backends/devices/sub_device.h"

#include <CL/opencl.hpp>
#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "platform/machine.h"

namespace mssim {
namespace {

using Property = cl_device_partition_property;

/// What asks the driver for a part of `count` compute units, in the way that leaves it least choice; none
/// where it knows none.
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

/// The part, or nothing where the driver has none.
std::optional<cl::Device> make_part(cl::Device device, int count) {
  try {
    const auto request = request_for(device, count);
    std::vector<cl::Device> parts;
    if (request) device.createSubDevices(request->data(), &parts);
    if (!parts.empty()) return parts.front();
  } catch (const cl::Error&) {
    // Drivers that know no parts, or not this one, say so by an error.
  }
  return std::nullopt;
}

}  // namespace

OpenclDevice part_of(const OpenclDevice& device, int count) {
  if (device.type != OpenclDeviceType::cpu || device.compute_units <= static_cast<std::uint32_t>(count))
    return device;
  // Never released: a driver may be gone before what would release them at the process's end.
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
  // Some drivers have more compute units than there are processors for their threads.
  static const std::size_t processors = process_cpus().size();
  const auto units = static_cast<int>(device.compute_units);
  return processors == 0 ? units : std::min(units, static_cast<int>(processors));
}

}  // namespace mssim
