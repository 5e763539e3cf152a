#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mssim {

// Environment variables that OpenCL's loader and PoCL, the driver for CPUs, read when they are loaded.

/// A driver that OpenCL's loader will load.
struct RegisteredDriver {
  std::filesystem::path file;  ///< the .icd file that registers it, or its library if that is named directly
  std::string shared_library;  ///< as named in that file
};

/// The drivers that the loader would load, by file name: those of OCL_ICD_VENDORS (a folder of .icd files,
/// one such file or a library), else of the folder of OPENCL_VENDOR_PATH or /etc/OpenCL/vendors.
std::vector<RegisteredDriver> registered_drivers();

/// Begin of a line in which libexec/mssim/ask-opencl (src/ask_opencl.cpp) reports why a driver offers no
/// platform. The driver's index in the list and the reason, a predicate, follow.
inline constexpr const char* obstacle_mark = "mssim: the driver with number ";

/// Is it PoCL, which has a cache of compiled kernels?
bool is_pocl(const RegisteredDriver& driver);

/// Makes PoCL bind each of its threads to its own core, unless the user has decided that. Otherwise they
/// sleep between short kernels, and Linux wakes two of them on one core: the spring forces of 38,233 nodes
/// then took 200 microseconds on two cores, and 110 to 150 with bound threads. PoCL numbers cores from 0, so
/// a process restricted to some cores must not bind them.
void bind_pocl_threads();

/// PoCL's folder of compiled kernels, without which it offers no device.
struct PoclCache {
  std::string failure;  ///< why the user's folder cannot be written, a sentence; or empty
  std::string note;     ///< the cost of having no permanent folder, a sentence; or empty
};

/// Makes sure that PoCL can write its cache: if its default folder cannot be written, sets POCL_CACHE_DIR to
/// mssim's folder in the user's cache folder or, if that cannot be written either, to a temporary folder that
/// is removed when the process ends.
PoclCache provide_pocl_cache();

}  // namespace mssim
