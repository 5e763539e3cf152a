#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "backends/devices/device.h"
#include "platform/machine.h"

namespace mssim {

/// The offer of this machine's OpenCL drivers.
struct OpenclOffer {
  std::vector<OpenclDevice> devices;  ///< of all platforms, in the drivers' order
  std::vector<std::string> troubles;  ///< a sentence for each driver that offers none or crashes
  std::string note;                   ///< a further note for users of a device, a sentence; or empty
};

/// Queries the drivers, once per process: first in another process (src/ask_opencl.cpp), because some drivers
/// crash. Those are excluded. Throws Interrupted (platform/process.h).
const OpenclOffer& opencl_offer();

/// Disables trials in another process: this process is itself one that drivers may crash.
void rely_on_opencl_drivers();

/// The device of this machine that `wanted` names (choose_opencl_device). Throws Unavailable if there is
/// none.
OpenclDevice find_opencl_device(std::string_view wanted);
/// The device that options.device names; if it is a CPU, part_of() it with options.threads.
OpenclDevice device_for(const ExecutionOptions& options);

// Some OpenCL drivers crash when they compile or launch unsupported code. So another process, also mssim,
// first makes each kind of backend for a small system. Programs depend only on the kind, so a driver with a
// cache of compiled code, like PoCL, need not compile it twice.

/// Kinds of systems for which a backend's programs differ.
enum class SteppedKind : std::uint8_t { cloth, bodies, alike_bodies, garment };

/// A backend to try in another process.
struct DriverTrial {
  std::string backend;     ///< its name
  std::string integrator;  ///< its name
  SteppedKind kind = SteppedKind::cloth;
  ExecutionOptions execution;
};

/// mssim's first argument in such a process; the trial's arguments follow.
inline constexpr std::string_view driver_trial_word = "--driver-trial";

/// Parses the arguments of a trial. They come from mssim itself: throws std::exception for any others.
DriverTrial driver_trial_from(std::span<char*> arguments);

/// Tries it, once per process and unless this process is itself a trial (rely_on_opencl_drivers). Throws
/// Unavailable if the driver crashed the other process or did not finish in half an hour; the sentence has
/// the driver's last words. Throws Interrupted.
void try_driver(const DriverTrial& trial, const OpenclDevice& device);

/// Adds the time for which it lives to compile_seconds().
class CompileTimer {
 public:
  CompileTimer() = default;
  ~CompileTimer();
  CompileTimer(const CompileTimer&) = delete;
  CompileTimer& operator=(const CompileTimer&) = delete;

 private:
  const Stopwatch watch_{};
};

/// Time for which this thread has waited so far until drivers had compiled, s: trials, builds, and the first
/// launches, at which some drivers finish compiling.
double compile_seconds();

/// From now on, `told` receives a sentence, from another thread, when a trial takes longer than ten seconds.
void hear_of_slow_drivers(std::function<void(const std::string& sentence)> told);

}  // namespace mssim
