// Asks all OpenCL drivers for their devices, and says nothing. A driver that ends the process that asks it
// ends this one, and not mssim, which runs it before it asks itself (backends/devices/offer.h).

#include <CL/cl.h>
#include <unistd.h>

#include <array>
#include <vector>

int main() {
  cl_uint count = 0;
  if (clGetPlatformIDs(0, nullptr, &count) == CL_SUCCESS) {
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
  // What drivers do at the end of a process is neither waited for nor told.
  _exit(0);
}
