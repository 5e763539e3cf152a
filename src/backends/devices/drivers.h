#pragma once

#include <cstdint>
#include <functional>
#include <span>
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

/// The device of this machine that `wanted` names (choose_opencl_device). Throws Unavailable where there is
/// none.
OpenclDevice find_opencl_device(std::string_view wanted);
/// The one that options.device names, and where that is a processor the part_of() it with options.threads.
OpenclDevice device_for(const ExecutionOptions& options);

// Some OpenCL drivers end the process in which they compile, or launch, what they cannot. So a process of its
// own, mssim too, makes each kind of backend for a small system before this one makes it. Programs depend on
// the kind alone, so that a driver that keeps what it has compiled, as PoCL does, need not compile it again.

/// What a backend steps, as far as its programs differ by it.
enum class SteppedKind : std::uint8_t { cloth, bodies, alike_bodies, garment };

/// What such a process is to make.
struct DriverTrial {
  std::string backend;     ///< its name
  std::string integrator;  ///< its name
  SteppedKind kind = SteppedKind::cloth;
  ExecutionOptions execution;
};

/// mssim's first argument where it is such a process; those of the trial follow.
inline constexpr std::string_view driver_trial_word = "--driver-trial";

/// The trial of those arguments. They are this program's own: throws std::exception for any others.
DriverTrial driver_trial_from(std::span<char*> arguments);

/// Tries it, once in a process and unless this process is a trial itself (rely_on_opencl_drivers). Throws
/// Unavailable where the driver has ended the other process or has not come to an end in half an hour; the
/// sentence has the driver's last words. Throws Interrupted.
void try_driver(const DriverTrial& trial, const OpenclDevice& device);

/// From now on `told` gets a sentence, from another thread, when such a trial takes longer than ten seconds.
void hear_of_slow_drivers(std::function<void(const std::string& sentence)> told);

}  // namespace mssim
