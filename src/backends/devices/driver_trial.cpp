#include "backends/devices/driver_trial.h"

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "backends/devices/offer.h"
#include "platform/files.h"
#include "platform/process.h"

namespace mssim {
namespace {

std::function<void(const std::string&)> listener;

/// Arguments of the trial on this device: what tells trials apart.
std::vector<std::string> arguments_of(const DriverTrial& trial, const OpenclDevice& device) {
  return {std::string(driver_trial_word),
          trial.backend,
          trial.integrator,
          std::to_string(static_cast<int>(trial.kind)),
          std::to_string(device.number),
          std::to_string(trial.execution.threads),
          std::to_string(static_cast<int>(trial.execution.memory))};
}

/// Calls `tell` once if it lives for so long.
class Patience {
 public:
  Patience(std::chrono::seconds most, const std::function<void()>& tell)
      : watch_([=](const std::stop_token& over) {
          std::mutex mutex;
          std::unique_lock lock(mutex);
          std::condition_variable_any end;
          end.wait_for(lock, over, most, [] { return false; });
          if (!over.stop_requested()) tell();
        }) {}

 private:
  std::jthread watch_;
};

/// How the trial went where it went wrong, a sentence; else empty.
std::string failure_of(const DriverTrial& trial, const OpenclDevice& device) {
  constexpr unsigned minute_s = 60, most_minutes = 30;  // llvmpipe compiles for minutes
  constexpr std::chrono::seconds told_after{10};
  const std::string driver = "the OpenCL driver \"" + device.platform + "\" ";
  const std::string what = "the kernels of " + trial.backend + " with " + trial.integrator;
  const Patience patience(told_after, [&] {
    if (listener) listener(driver + "is compiling " + what + ", which takes some drivers minutes");
  });
  // Processor time is of all threads.
  const ChildResult result = run({mssim_program(),
                                  arguments_of(trial, device),
                                  {},
                                  ".",
                                  most_minutes * minute_s * device.compute_units,
                                  most_minutes * minute_s});
  if (result.out_of_time)
    return driver + "had not compiled " + what + " after " + std::to_string(most_minutes) + " minutes";
  const std::string end = failed_end(result, "it compiled " + what);
  return end.empty() ? "" : driver + end;
}

}  // namespace

void hear_of_slow_drivers(std::function<void(const std::string& sentence)> told) {
  listener = std::move(told);
}

DriverTrial driver_trial_from(std::span<char*> arguments) {
  if (arguments.size() != 6) throw std::invalid_argument("a trial of a driver has six arguments");
  DriverTrial trial{arguments[0], arguments[1], static_cast<SteppedKind>(std::stoi(arguments[2])), {}};
  trial.execution.device = arguments[3];
  trial.execution.threads = std::stoi(arguments[4]);
  trial.execution.memory = static_cast<DeviceMemory>(std::stoi(arguments[5]));
  return trial;
}

void try_driver(const DriverTrial& trial, const OpenclDevice& device) {
  if (opencl_drivers_relied_on()) return;
  static std::map<std::vector<std::string>, std::string> failures;
  const auto [tried, is_new] = failures.try_emplace(arguments_of(trial, device));
  if (is_new) tried->second = failure_of(trial, device);
  if (!tried->second.empty()) throw Unavailable(tried->second);
}

}  // namespace mssim
