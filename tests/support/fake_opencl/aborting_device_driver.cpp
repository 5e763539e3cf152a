// An OpenCL driver that ends the process that asks it for devices.
#include <cstdlib>

#include "fake_driver.h"

cl_int CL_API_CALL fake_opencl::device_ids(cl_platform_id, cl_device_type, cl_uint, cl_device_id*, cl_uint*) {
  std::abort();
}

extern "C" cl_int clIcdGetPlatformIDsKHR(cl_uint num_entries, cl_platform_id* platforms,
                                         cl_uint* num_platforms) {
  return fake_opencl::give_platform(num_entries, platforms, num_platforms);
}

extern "C" void* clGetExtensionFunctionAddress(const char* func_name) {
  return fake_opencl::function_named(func_name);
}
