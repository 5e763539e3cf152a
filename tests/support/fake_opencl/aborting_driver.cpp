// An OpenCL driver that ends the process that loads it, as PoCL does where it finds no memory. Leaves a file
// FAKE_OPENCL_LOADED, so that a test sees that it was loaded.
#include <CL/cl_icd.h>

#include <cstdio>
#include <cstdlib>

extern "C" cl_int clIcdGetPlatformIDsKHR(cl_uint, cl_platform_id*, cl_uint*) {
  if (const char* trace = std::getenv("FAKE_OPENCL_LOADED"))
    if (std::FILE* file = std::fopen(trace, "w")) std::fclose(file);
  std::fputs("warming up\nNot enough memory to run on this device.\n", stderr);
  std::abort();
}

extern "C" void* clGetExtensionFunctionAddress(const char*) {
  return reinterpret_cast<void*>(clIcdGetPlatformIDsKHR);
}
