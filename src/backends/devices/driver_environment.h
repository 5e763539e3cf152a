#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mssim {

// What OpenCL's loader and PoCL, the driver that makes the processor a device, read from the environment when
// they are loaded.

/// A driver that OpenCL's loader is told to load.
struct RegisteredDriver {
  std::filesystem::path file;  ///< the .icd file that registers it, or its library where it was named itself
  std::string shared_library;  ///< as that file names it
};

/// The drivers that the loader would load, by their files' names: what OCL_ICD_VENDORS names, a folder of
/// .icd files, one such file or a library, else the folder of OPENCL_VENDOR_PATH or /etc/OpenCL/vendors.
std::vector<RegisteredDriver> registered_drivers();

/// How a line begins in which libexec/mssim/ask-opencl (src/ask_opencl.cpp) says what keeps a driver from
/// offering a platform. The driver's place in the list and the obstacle, a verb and what follows it, come
/// next.
inline constexpr const char* obstacle_mark = "mssim: the driver with number ";

/// Is that PoCL, which has a cache of compiled kernels?
bool is_pocl(const RegisteredDriver& driver);

/// Asks PoCL for a core of its own for each of its threads, unless the user has decided that. Between short
/// kernels they sleep, and Linux wakes two of them on one core: the spring forces of 38,233 nodes then took
/// 200 microseconds on two cores, 110 to 150 with this. PoCL numbers cores from 0, so that a process that is
/// kept from some of them must not ask.
void bind_pocl_threads();

/// Where PoCL keeps compiled kernels, without which it offers no device.
struct PoclCache {
  std::string failure;  ///< why the folder that the user chose cannot be written, a sentence; else empty
  std::string note;     ///< what it costs that no lasting folder can be written, a sentence; else empty
};

/// Sees to it that PoCL can write its cache: where it would take a folder by itself that cannot be written,
/// POCL_CACHE_DIR becomes mssim's own in the user's folder for caches or, where that cannot be written
/// either, a temporary one that goes away when the process ends.
PoclCache provide_pocl_cache();

}  // namespace mssim
