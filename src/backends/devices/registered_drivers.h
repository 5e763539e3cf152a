#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mssim {

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

}  // namespace mssim
