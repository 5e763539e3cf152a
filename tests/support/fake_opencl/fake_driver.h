#pragma once

// An OpenCL driver of one platform, as far as the loader asks it; included once, by a file that defines
// device_ids.

#include <CL/cl_icd.h>

#include <cstring>

struct _cl_platform_id {
  cl_icd_dispatch* dispatch;
};

namespace fake_opencl {

/// clGetDeviceIDs of this driver.
cl_int CL_API_CALL device_ids(cl_platform_id, cl_device_type, cl_uint, cl_device_id*, cl_uint*);

inline cl_icd_dispatch calls;
inline _cl_platform_id platform{&calls};

inline cl_int CL_API_CALL platform_info(cl_platform_id, cl_platform_info what, size_t size, void* value,
                                        size_t* size_needed) {
  const char* text = what == CL_PLATFORM_EXTENSIONS       ? "cl_khr_icd"
                     : what == CL_PLATFORM_ICD_SUFFIX_KHR ? "FAKE"
                     : what == CL_PLATFORM_VERSION        ? "OpenCL 3.0 fake"
                                                          : "A fake driver";
  const size_t needed = std::strlen(text) + 1;
  if (value != nullptr && size < needed) return CL_INVALID_VALUE;
  if (value != nullptr) std::memcpy(value, text, needed);
  if (size_needed != nullptr) *size_needed = needed;
  return CL_SUCCESS;
}

}  // namespace fake_opencl

// NOLINTBEGIN(misc-definitions-in-headers): included once, as said above
extern "C" cl_int clIcdGetPlatformIDsKHR(cl_uint num_entries, cl_platform_id* platforms,
                                         cl_uint* num_platforms) {
  fake_opencl::calls.clGetPlatformInfo = fake_opencl::platform_info;
  fake_opencl::calls.clGetDeviceIDs = fake_opencl::device_ids;
  if (platforms != nullptr && num_entries > 0) *platforms = &fake_opencl::platform;
  if (num_platforms != nullptr) *num_platforms = 1;
  return CL_SUCCESS;
}

extern "C" void* clGetExtensionFunctionAddress(const char* func_name) {
  if (std::strcmp(func_name, "clIcdGetPlatformIDsKHR") == 0)
    return reinterpret_cast<void*>(clIcdGetPlatformIDsKHR);
  if (std::strcmp(func_name, "clGetPlatformInfo") == 0)
    return reinterpret_cast<void*>(fake_opencl::platform_info);
  return nullptr;
}
// NOLINTEND(misc-definitions-in-headers)
