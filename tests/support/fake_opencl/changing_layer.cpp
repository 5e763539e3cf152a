// An OpenCL layer under which devices are others than they are. Taken by OPENCL_LAYERS; the words of
// FAKE_OPENCL say how: undividable: no device can be divided; gpu: all are GPUs; own-memory: no device shares
// the host's memory; dies: compiling ends the process; hangs: compiling goes on for ever; float-N: vectors of
// N floats suit them.
#include <CL/cl_layer.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

cl_icd_dispatch real, calls;

/// What follows `word` among those that were asked for; null where it is none of them.
const char* asked(const char* word) {
  const char* all = std::getenv("FAKE_OPENCL");
  const char* found = all == nullptr ? nullptr : std::strstr(all, word);
  return found == nullptr ? nullptr : found + std::strlen(word);
}

cl_int CL_API_CALL refuse(cl_device_id, const cl_device_partition_property*, cl_uint, cl_device_id*,
                          cl_uint*) {
  return CL_DEVICE_PARTITION_FAILED;
}

cl_int CL_API_CALL device_info(cl_device_id device, cl_device_info what, size_t size, void* value,
                               size_t* size_needed) {
  const cl_int error = real.clGetDeviceInfo(device, what, size, value, size_needed);
  if (error != CL_SUCCESS || value == nullptr) return error;
  const char* width = asked("float-");
  if (what == CL_DEVICE_TYPE && asked("gpu") != nullptr)
    *static_cast<cl_device_type*>(value) = CL_DEVICE_TYPE_GPU;
  else if (what == CL_DEVICE_HOST_UNIFIED_MEMORY && asked("own-memory") != nullptr)
    *static_cast<cl_bool*>(value) = CL_FALSE;
  else if (what == CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT && width != nullptr)
    *static_cast<cl_uint*>(value) = static_cast<cl_uint>(std::atoi(width));
  else if (what == CL_DEVICE_PREFERRED_VECTOR_WIDTH_FLOAT && width != nullptr)
    *static_cast<cl_uint*>(value) = 1;
  return error;
}

cl_int CL_API_CALL build(cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
                         void(CL_CALLBACK* notify)(cl_program, void*), void* data) {
  if (asked("dies") != nullptr) {
    std::fputs("LLVM ERROR: cannot select fma\nstack dump\n", stderr);
    std::abort();
  }
  while (asked("hangs") != nullptr) ::sleep(1);
  return real.clBuildProgram(program, count, devices, options, notify, data);
}

}  // namespace

extern "C" cl_int clGetLayerInfo(cl_layer_info param_name, size_t param_value_size, void* param_value,
                                 size_t* param_value_size_ret) {
  constexpr cl_layer_api_version version = CL_LAYER_API_VERSION_100;
  if (param_name != CL_LAYER_API_VERSION) return CL_INVALID_VALUE;
  if (param_value != nullptr && param_value_size < sizeof version) return CL_INVALID_VALUE;
  if (param_value != nullptr) std::memcpy(param_value, &version, sizeof version);
  if (param_value_size_ret != nullptr) *param_value_size_ret = sizeof version;
  return CL_SUCCESS;
}

extern "C" cl_int clInitLayer(cl_uint num_entries, const cl_icd_dispatch* target_dispatch,
                              cl_uint* num_entries_ret, const cl_icd_dispatch** layer_dispatch_ret) {
  std::memcpy(&real, target_dispatch, std::min(num_entries * sizeof(void*), sizeof real));
  calls = real;
  if (asked("undividable") != nullptr) calls.clCreateSubDevices = refuse;
  calls.clGetDeviceInfo = device_info;
  calls.clBuildProgram = build;
  *layer_dispatch_ret = &calls;
  *num_entries_ret = sizeof calls / sizeof(void*);
  return CL_SUCCESS;
}
