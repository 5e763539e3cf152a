#include "backends/devices/drivers.h"

#include <CL/cl_ext.h>
#include <sys/resource.h>

#include <CL/opencl.hpp>
#include <algorithm>
#include <cctype>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <utility>

#include "backends/devices/driver_environment.h"
#include "platform/files.h"
#include "platform/process.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr const char* vendors_variable = "OCL_ICD_VENDORS";
constexpr const char* pocl_platform = "Portable Computing Language";

bool relied_on = false;
thread_local double compiled_s = 0;
std::function<void(const std::string&)> listener;

/// Findings of the query process.
struct Answer {
  std::string end;  ///< how the query crashed, for the end of a sentence; empty if it did not
  std::vector<std::string> troubles;  ///< a sentence for each driver that offers no platform
};

std::string name_of(const RegisteredDriver& driver) {
  return "the OpenCL driver " +
         (driver.shared_library.empty() ? driver.file.string() : driver.shared_library);
}

/// The file that registers a driver, for the end of a sentence with its name_of().
std::string registration_of(const RegisteredDriver& driver) {
  return driver.shared_library.empty() ? "" : fmt::format(" ({} registers it)", driver.file.string());
}

/// Queries the drivers in another process.
Answer ask_in_child(const std::vector<RegisteredDriver>& drivers,
                    const std::vector<std::string>& environment) {
  constexpr unsigned cpu_s = 60, elapsed_s = 120;
  const auto libraries = mapped<std::string>(drivers, &RegisteredDriver::shared_library);
  const ChildResult asked =
      run({helper_program("ask-opencl"), libraries, environment, ".", cpu_s, elapsed_s});
  Answer answer{failed_end(asked, "queried for devices"), {}};
  if (asked.out_of_time)
    answer.end = fmt::format("did not answer within {} s of CPU time or {} s in all when queried for devices",
                             cpu_s, elapsed_s);
  std::istringstream lines(asked.output);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(obstacle_mark)) continue;
    std::istringstream words(line.substr(std::string_view(obstacle_mark).size()));
    std::size_t number = 0;
    std::string obstacle;
    if (words >> number && std::getline(words >> std::ws, obstacle) && number < drivers.size())
      answer.troubles.push_back(name_of(drivers[number]) + ' ' + obstacle + registration_of(drivers[number]));
  }
  return answer;
}

/// Queries each driver separately; registers the surviving ones in `folder`, and returns how the others
/// ended.
std::vector<std::string> keep_survivors(const std::vector<RegisteredDriver>& drivers,
                                        const std::filesystem::path& folder) {
  std::vector<std::string> troubles;
  for (const RegisteredDriver& driver : drivers) {
    const std::filesystem::path file = std::filesystem::absolute(driver.file);
    const Answer answer = ask_in_child({}, {std::string(vendors_variable) + '=' + file.string()});
    if (!answer.end.empty())
      troubles.push_back(name_of(driver) + ' ' + answer.end);
    else
      std::filesystem::create_symlink(file, folder / file.filename());
  }
  return troubles;
}

/// The items that `query` returns, or nothing if the driver's error is `none`.
template <class Item, class Query>
std::vector<Item> all_or_none(Query query, cl_int none) {
  std::vector<Item> items;
  try {
    query(items);
  } catch (const cl::Error& error) {
    if (error.err() != none) throw;
    items.clear();
  }
  return items;
}

OpenclDeviceType type_of(cl_device_type type) {
  if ((type & CL_DEVICE_TYPE_GPU) != 0) return OpenclDeviceType::gpu;
  if ((type & CL_DEVICE_TYPE_CPU) != 0) return OpenclDeviceType::cpu;
  return OpenclDeviceType::other;
}

HostMemory host_memory_of(const cl::Device& device) {
  if (device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() != CL_TRUE) return HostMemory::none;
  // Before OpenCL 2.0 the query is an error.
  cl_device_svm_capabilities can = 0;
  const cl_int error = clGetDeviceInfo(device(), CL_DEVICE_SVM_CAPABILITIES, sizeof can, &can, nullptr);
  return error == CL_SUCCESS && (can & CL_DEVICE_SVM_FINE_GRAIN_BUFFER) != 0 ? HostMemory::fine_grained
                                                                             : HostMemory::mapped;
}

/// A driver's text without its terminating zero and the spaces that pad some names.
std::string trimmed(std::string text) {
  const auto blank = [](char c) { return c == '\0' || std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && blank(text.back())) text.pop_back();
  text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), blank));
  return text;
}

/// The properties that the device reports. May throw cl::Error.
OpenclDevice described(cl_device_id id, const std::string& platform, int number) {
  const cl::Device device(id, true);
  return {.number = number,
          .name = trimmed(device.getInfo<CL_DEVICE_NAME>()),
          .platform = platform,
          .driver_version = trimmed(device.getInfo<CL_DRIVER_VERSION>()),
          .type = type_of(device.getInfo<CL_DEVICE_TYPE>()),
          .compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>(),
          .global_memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>(),
          .max_allocation_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>(),
          .float_width = std::max(device.getInfo<CL_DEVICE_PREFERRED_VECTOR_WIDTH_FLOAT>(),
                                  device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>()),
          .host_memory = host_memory_of(device),
          .id = id};
}

/// Adds the devices of a platform to the offer.
void take_devices(const cl::Platform& platform, const std::string& pocl_failure, OpenclOffer& offer) {
  const std::string name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
  const auto driver = [&] { return fmt::format("the OpenCL driver \"{}\"", name); };
  try {
    // A driver reports an error if it has no device.
    const auto devices = all_or_none<cl::Device>(
        [&](auto& all) { platform.getDevices(CL_DEVICE_TYPE_ALL, &all); }, CL_DEVICE_NOT_FOUND);
    for (const cl::Device& device : devices)
      offer.devices.push_back(described(device(), name, static_cast<int>(offer.devices.size())));
    if (!devices.empty()) return;
    const bool lacks_cache = name == pocl_platform && !pocl_failure.empty();
    offer.troubles.push_back(driver() + " offers no device" + (lacks_cache ? ": " + pocl_failure : ""));
  } catch (const cl::Error& error) {
    offer.troubles.push_back(driver() + " fails: " + opencl_failure(error.what(), error.err()));
  }
}

/// Loads into this process the drivers that survived the query, with its answer, and adds their devices.
void take_devices(Answer answer, const std::string& pocl_failure, OpenclOffer& offer) {
  const OnAllProcessCpus every;  // PoCL starts its threads here
  // The loader reports an error if there is no driver.
  const auto platforms =
      all_or_none<cl::Platform>([](auto& all) { cl::Platform::get(&all); }, CL_PLATFORM_NOT_FOUND_KHR);
  for (const cl::Platform& platform : platforms) take_devices(platform, pocl_failure, offer);
  std::ranges::move(answer.troubles, std::back_inserter(offer.troubles));
}

/// Called if a query of all drivers crashed: loads those that survive alone. From then on they are the
/// registered drivers of this process and its child processes.
void take_survivors(const std::vector<RegisteredDriver>& drivers, const std::string& pocl_failure,
                    OpenclOffer& offer) {
  const std::filesystem::path survivors = temporary_folder_of_process() / "opencl-drivers";
  std::filesystem::create_directory(survivors);
  offer.troubles = keep_survivors(drivers, survivors);
  if (offer.troubles.size() == drivers.size()) return;
  setenv(vendors_variable, survivors.c_str(), 1);
  Answer answer = ask_in_child(registered_drivers(), {});
  if (!answer.end.empty())
    offer.troubles.push_back(fmt::format("the OpenCL drivers {}, but each one alone survives", answer.end));
  else
    take_devices(std::move(answer), pocl_failure, offer);
}

/// PoCL ends the process if it cannot allocate. It needs about 0.35 GB of address space.
void require_address_space() {
  constexpr rlim_t least_bytes = rlim_t{512} << 20;
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur < least_bytes)
    throw std::runtime_error(
        fmt::format("PoCL needs {} MiB of address space, and ulimit -v allows {}; raise that limit",
                    least_bytes >> 20, limit.rlim_cur >> 20));
}

OpenclOffer ask() {
  OpenclOffer offer;
  const std::vector<RegisteredDriver> drivers = registered_drivers();
  if (std::ranges::any_of(drivers, is_pocl)) require_address_space();
  bind_pocl_threads();
  PoclCache cache;
  if (std::ranges::any_of(drivers, is_pocl)) cache = provide_pocl_cache();
  offer.note = cache.note;
  Answer answer = relied_on ? Answer{} : ask_in_child(drivers, {});
  if (answer.end.empty())
    take_devices(std::move(answer), cache.failure, offer);
  else if (drivers.size() > 1)
    take_survivors(drivers, cache.failure, offer);
  else
    offer.troubles.push_back((drivers.empty() ? "the OpenCL library" : name_of(drivers.front())) + ' ' +
                             answer.end);
  return offer;
}

/// Arguments of the trial on this device; they identify the trial.
std::vector<std::string> arguments_of(const DriverTrial& trial, const OpenclDevice& device) {
  return {std::string(driver_trial_word),
          trial.backend,
          trial.integrator,
          std::to_string(static_cast<int>(trial.kind)),
          std::to_string(device.number),
          std::to_string(trial.execution.threads),
          std::to_string(static_cast<int>(trial.execution.memory))};
}

/// Calls `tell` once if it lives longer than a limit.
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

/// The failure of the trial, a sentence; empty if it succeeded.
std::string failure_of(const DriverTrial& trial, const OpenclDevice& device) {
  constexpr unsigned minute_s = 60, most_minutes = 30;  // llvmpipe compiles for minutes
  constexpr std::chrono::seconds told_after{10};
  const std::string driver = fmt::format("the OpenCL driver \"{}\" ", device.platform);
  const std::string what = fmt::format("the kernels of {} with {}", trial.backend, trial.integrator);
  const Patience patience(told_after, [&] {
    if (listener) listener(fmt::format("{}is compiling {}, which takes some drivers minutes", driver, what));
  });
  // CPU time counts all threads.
  ChildResult result;
  try {
    result = run({mssim_program(),
                  arguments_of(trial, device),
                  {},
                  ".",
                  most_minutes * minute_s * device.compute_units,
                  most_minutes * minute_s});
  } catch (const MissingProgram& cannot_start) {
    return fmt::format("{}cannot be tried: {}", driver, cannot_start.what());
  }
  if (result.out_of_time)
    return fmt::format("{}had not compiled {} after {} minutes", driver, what, most_minutes);
  const std::string end = failed_end(result, "it compiled " + what);
  return end.empty() ? "" : driver + end;
}

}  // namespace

void rely_on_opencl_drivers() { relied_on = true; }

const OpenclOffer& opencl_offer() {
  static const OpenclOffer offer = [] {
    try {
      return ask();
    } catch (const cl::Error& error) {
      return OpenclOffer{{}, {opencl_failure(error.what(), error.err())}, {}};
    } catch (const std::runtime_error& error) {
      return OpenclOffer{{}, {std::string("the OpenCL drivers cannot be queried: ") + error.what()}, {}};
    }
  }();
  return offer;
}

OpenclDevice find_opencl_device(std::string_view wanted) {
  const OpenclOffer& offer = opencl_offer();
  if (offer.devices.empty() && !offer.troubles.empty()) throw Unavailable(join(offer.troubles, "; "));
  return choose_opencl_device(offer.devices, wanted);
}

OpenclDevice device_for(const ExecutionOptions& options) {
  return part_of(find_opencl_device(options.device), options.threads);
}

void hear_of_slow_drivers(std::function<void(const std::string& sentence)> told) {
  listener = std::move(told);
}

CompileTimer::~CompileTimer() { compiled_s += watch_.seconds(); }

double compile_seconds() { return compiled_s; }

DriverTrial driver_trial_from(std::span<char*> arguments) {
  if (arguments.size() != 6) throw std::invalid_argument("a trial of a driver has six arguments");
  DriverTrial trial{arguments[0], arguments[1], static_cast<SteppedKind>(std::stoi(arguments[2])), {}};
  trial.execution.device = arguments[3];
  trial.execution.threads = std::stoi(arguments[4]);
  trial.execution.memory = static_cast<DeviceMemory>(std::stoi(arguments[5]));
  return trial;
}

void try_driver(const DriverTrial& trial, const OpenclDevice& device) {
  if (relied_on) return;
  static std::map<std::vector<std::string>, std::string> failures;
  const auto [tried, is_new] = failures.try_emplace(arguments_of(trial, device));
  const CompileTimer timer;
  if (is_new) tried->second = failure_of(trial, device);
  if (!tried->second.empty()) throw Unavailable(tried->second);
}

}  // namespace mssim
