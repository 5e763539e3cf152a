#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "backends/devices/device.h"

namespace mssim {

/// What the OpenCL drivers of this machine offer.
struct OpenclOffer {
  std::vector<OpenclDevice> devices;  ///< of all platforms, in the order of the drivers
  std::vector<std::string>
      troubles;      ///< a sentence for each driver that offers none, or ends whoever asks it
  std::string note;  ///< what a user of a device should know beside that, a sentence; or empty
};

/// Asks the drivers, once in a process: first in another process (src/ask_opencl.cpp), since some end the one
/// that asks them. Those are left out. Throws Interrupted (platform/process.h).
const OpenclOffer& opencl_offer();

/// From now on nothing is tried in another process first: this one is itself a process that drivers may end.
void rely_on_opencl_drivers();
bool opencl_drivers_relied_on();

/// The device of this machine that `wanted` names (choose_opencl_device). Throws Unavailable where there is
/// none.
OpenclDevice find_opencl_device(std::string_view wanted);

}  // namespace mssim
