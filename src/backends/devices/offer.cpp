#include "backends/devices/offer.h"

#include <CL/cl_ext.h>

#include <CL/opencl.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "backends/devices/pocl_settings.h"
#include "backends/devices/registered_drivers.h"
#include "platform/child_process.h"
#include "platform/data_folder.h"
#include "platform/process_cpus.h"
#include "platform/temporary_folder.h"
#include "text/joined.h"

namespace mssim {
namespace {

constexpr const char* vendors_variable = "OCL_ICD_VENDORS";
constexpr const char* pocl_platform = "Portable Computing Language";

/// An environment variable that has a value for a while.
class TemporaryValue {
 public:
  TemporaryValue(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name); before != nullptr) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~TemporaryValue() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
  TemporaryValue(const TemporaryValue&) = delete;
  TemporaryValue& operator=(const TemporaryValue&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

std::string last_line(std::string_view text) {
  text = text.substr(0, text.find_last_not_of(" \n\r\t") + 1);
  return std::string(text.substr(text.find_last_of('\n') + 1));
}

/// How asking ended the process that asked, for the end of a sentence; nothing where it did not.
std::optional<std::string> end_of_asking(const std::vector<std::string>& environment) {
  constexpr unsigned cpu_s = 60, elapsed_s = 120;
  const ChildResult asked = run({helper_program("ask-opencl"), {}, environment, ".", cpu_s, elapsed_s});
  if (asked.signal == 0 && asked.exit_code == 0) return std::nullopt;
  if (asked.out_of_time)
    return "did not answer within " + std::to_string(cpu_s) + " s of processor time or " +
           std::to_string(elapsed_s) + " s in all when asked for devices";
  const std::string line = last_line(asked.output);
  return "ended with " +
         (asked.signal != 0 ? "signal " + std::to_string(asked.signal)
                            : "exit code " + std::to_string(asked.exit_code)) +
         " when asked for devices" + (line.empty() ? "" : ": " + line);
}

std::string name_of(const RegisteredDriver& driver) {
  return "the OpenCL driver " +
         (driver.shared_library.empty() ? driver.file.string() : driver.shared_library);
}

/// Asks each driver alone; registers those that survive it in `folder`, and says of the others how it ended.
std::vector<std::string> keep_survivors(const std::vector<RegisteredDriver>& drivers,
                                        const std::filesystem::path& folder) {
  std::vector<std::string> troubles;
  for (const RegisteredDriver& driver : drivers) {
    const std::filesystem::path file = std::filesystem::absolute(driver.file);
    if (const auto end = end_of_asking({std::string(vendors_variable) + '=' + file.string()}))
      troubles.push_back(name_of(driver) + ' ' + *end);
    else
      std::filesystem::create_symlink(file, folder / file.filename());
  }
  return troubles;
}

/// What `query` fills its argument with, or nothing where the driver answers that there is `none`.
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

/// Takes what a platform offers.
void take_devices(const cl::Platform& platform, const std::string& pocl_failure, OpenclOffer& offer) {
  const std::string name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
  const auto driver = [&] { return "the OpenCL driver \"" + name + '"'; };
  try {
    // A driver reports it as an error that it has no device.
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

/// Loads the drivers into this process, and takes what they offer.
void take_devices(const std::vector<RegisteredDriver>& drivers, const std::string& pocl_failure,
                  OpenclOffer& offer) {
  const OnAllProcessCpus every;  // PoCL starts its threads here
  // The loader reports it as an error that there is no driver.
  const auto platforms =
      all_or_none<cl::Platform>([](auto& all) { cl::Platform::get(&all); }, CL_PLATFORM_NOT_FOUND_KHR);
  for (const cl::Platform& platform : platforms) take_devices(platform, pocl_failure, offer);
  if (!platforms.empty()) return;
  for (const RegisteredDriver& driver : drivers)
    offer.troubles.push_back(name_of(driver) + " cannot be loaded, or offers nothing (" +
                             driver.file.string() + " registers it)");
}

/// Loads those drivers that survive it alone, where asking all has ended the process that asked.
void take_survivors(const std::vector<RegisteredDriver>& drivers, const std::string& pocl_failure,
                    OpenclOffer& offer) {
  const TemporaryFolder survivors;
  offer.troubles = keep_survivors(drivers, survivors.path());
  if (offer.troubles.size() == drivers.size()) return;
  const TemporaryValue vendors(vendors_variable, survivors.path().string());
  if (const auto end = end_of_asking({}))
    offer.troubles.push_back("the OpenCL drivers " + *end + ", but each one alone survives");
  else
    take_devices(registered_drivers(), pocl_failure, offer);
}

OpenclOffer ask() {
  OpenclOffer offer;
  const std::vector<RegisteredDriver> drivers = registered_drivers();
  bind_pocl_threads();
  PoclCache cache;
  if (std::ranges::any_of(drivers, is_pocl)) cache = provide_pocl_cache();
  offer.note = cache.note;
  if (const auto end = end_of_asking({}); !end)
    take_devices(drivers, cache.failure, offer);
  else if (drivers.size() > 1)
    take_survivors(drivers, cache.failure, offer);
  else
    offer.troubles.push_back((drivers.empty() ? "the OpenCL library" : name_of(drivers.front())) + ' ' +
                             *end);
  return offer;
}

}  // namespace

const OpenclOffer& opencl_offer() {
  static const OpenclOffer offer = [] {
    try {
      return ask();
    } catch (const cl::Error& error) {
      return OpenclOffer{{}, {opencl_failure(error.what(), error.err())}, {}};
    } catch (const std::runtime_error& error) {
      return OpenclOffer{{}, {std::string("the OpenCL drivers cannot be asked: ") + error.what()}, {}};
    }
  }();
  return offer;
}

OpenclDevice find_opencl_device(std::string_view wanted) {
  const OpenclOffer& offer = opencl_offer();
  if (offer.devices.empty() && !offer.troubles.empty()) throw Unavailable(joined(offer.troubles, "; "));
  return choose_opencl_device(offer.devices, wanted);
}

}  // namespace mssim
