#include "backends/devices/driver_environment.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "platform/files.h"
#include "platform/machine.h"
#include "platform/process.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

constexpr const char* usual_folder = "/etc/OpenCL/vendors";

RegisteredDriver registered_by(const fs::path& icd_file) {
  std::string library;
  std::ifstream(icd_file) >> library;
  return {icd_file, library};
}

std::vector<RegisteredDriver> registered_in(const fs::path& folder) {
  std::vector<RegisteredDriver> drivers;
  for (const fs::path& file : entries_of(folder))
    if (file.extension() == ".icd") drivers.push_back(registered_by(file));
  return drivers;
}

constexpr const char* cache_variable = "POCL_CACHE_DIR";

/// Empty if the folder exists or can be made, and files can be made in it; else the system's reason.
std::string obstacle_to_writing(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return error.message();
  std::string name = (folder / "mssim-XXXXXX").string();
  const int file = ::mkstemp(name.data());
  if (file < 0) return std::strerror(errno);
  ::close(file);
  ::unlink(name.c_str());
  return "";
}

/// PoCL's default cache (lib/CL/pocl_cache.c).
fs::path default_cache() {
  if (const std::string caches = variable("XDG_CACHE_HOME"); !caches.empty())
    return fs::path(caches) / "pocl" / "kcache";
  if (const char* home = std::getenv("HOME"); home != nullptr)
    return fs::path(home) / ".cache" / "pocl" / "kcache";
  return "/tmp/pocl/kcache";
}

}  // namespace

std::vector<RegisteredDriver> registered_drivers() {
  std::error_code error;
  const fs::path chosen = variable("OCL_ICD_VENDORS");
  if (chosen.empty()) {
    const fs::path folder = variable("OPENCL_VENDOR_PATH");
    return registered_in(folder.empty() ? usual_folder : folder);
  }
  if (fs::is_directory(chosen, error)) return registered_in(chosen);
  if (chosen.extension() != ".icd") return {{chosen, chosen.string()}};
  return {registered_by(chosen.has_parent_path() ? chosen : usual_folder / chosen)};
}

bool is_pocl(const RegisteredDriver& driver) {
  return driver.shared_library.find("pocl") != std::string::npos;
}

void bind_pocl_threads() {
  if (std::ssize(process_cpus()) == sysconf(_SC_NPROCESSORS_CONF)) setenv("POCL_AFFINITY", "1", 0);
}

PoclCache provide_pocl_cache() {
  PoclCache cache;
  if (const std::string chosen = variable(cache_variable); !chosen.empty()) {
    if (const std::string obstacle = obstacle_to_writing(chosen); !obstacle.empty())
      cache.failure = "its cache " + chosen + " cannot be written (" + obstacle +
                      "); set POCL_CACHE_DIR to a folder that can be, or unset it";
    return cache;
  }
  const fs::path usual = default_cache();
  const std::string obstacle = obstacle_to_writing(usual);
  if (obstacle.empty()) {
    // An empty value crashes PoCL's process.
    if (std::getenv(cache_variable) != nullptr) setenv(cache_variable, usual.c_str(), 1);
    return cache;
  }
  if (const fs::path own = cache_folder("pocl"); !own.empty() && obstacle_to_writing(own).empty()) {
    setenv(cache_variable, own.c_str(), 1);
    return cache;
  }
  const std::string cannot = fmt::format("PoCL's cache {} cannot be written ({})", usual.string(), obstacle);
  try {
    setenv(cache_variable, temporary_folder_of_process().c_str(), 1);
    cache.note =
        cannot + ", so every run compiles its kernels again; set POCL_CACHE_DIR to a folder that can be";
  } catch (const std::runtime_error& error) {
    cache.failure = fmt::format("its cache {} cannot be written ({}), and mssim {}", usual.string(), obstacle,
                                error.what());
  }
  return cache;
}

}  // namespace mssim
