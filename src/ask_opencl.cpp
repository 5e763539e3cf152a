// Queries all OpenCL drivers for their devices. A driver that crashes ends this process instead of mssim,
// which runs it before its own query (backends/devices/drivers.h). The arguments are the libraries of the
// registered drivers. For each driver without a platform, stdout has the reason: a line of obstacle_mark, its
// number and the problem.

#include <CL/cl_icd.h>
#include <dlfcn.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "backends/devices/driver_environment.h"

namespace {

void ask_for_devices() {
  cl_uint count = 0;
  if (clGetPlatformIDs(0, nullptr, &count) != CL_SUCCESS) return;
  std::vector<cl_platform_id> platforms(count);
  clGetPlatformIDs(count, platforms.data(), nullptr);
  for (cl_platform_id platform : platforms) {
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count) != CL_SUCCESS) continue;
    std::vector<cl_device_id> devices(count);
    clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, devices.data(), nullptr);
    for (cl_device_id device : devices) {
      std::array<char, 1024> name;
      clGetDeviceInfo(device, CL_DEVICE_NAME, name.size(), name.data(), nullptr);
    }
  }
}

/// Why the loader gets no platform from that library; empty if it does. Loads it as the loader does.
std::string obstacle_of(const char* library) {
  if (*library == '\0') return "names no library";
  void* const driver = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
  if (driver == nullptr) return std::string("cannot be loaded: ") + dlerror();
  using FindFunction = void* (*)(const char*);
  const auto find = reinterpret_cast<FindFunction>(dlsym(driver, "clGetExtensionFunctionAddress"));
  void* const function = find == nullptr ? nullptr : find("clIcdGetPlatformIDsKHR");
  if (function == nullptr) return "is not a driver that OpenCL's loader can use";
  cl_uint count = 0;
  const cl_int error = reinterpret_cast<clIcdGetPlatformIDsKHR_fn>(function)(0, nullptr, &count);
  return error == CL_SUCCESS && count > 0 ? "" : "offers no platform";
}

}  // namespace

int main(int argc, char** argv) {
  ask_for_devices();
  for (int i = 1; i < argc; ++i)
    if (const std::string obstacle = obstacle_of(argv[i]); !obstacle.empty())
      std::printf("\n%s%d %s\n", mssim::obstacle_mark, i - 1, obstacle.c_str());
  std::fflush(stdout);
  // Do not wait for what drivers do at the end of a process.
  _exit(0);
}
