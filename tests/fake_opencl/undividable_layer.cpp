// An OpenCL layer under which no device can be divided, as with some drivers. Taken by OPENCL_LAYERS.
#include <CL/cl_layer.h>

#include <algorithm>
#include <cstring>

namespace {

cl_icd_dispatch calls;

cl_int CL_API_CALL refuse(cl_device_id, const cl_device_partition_property*, cl_uint, cl_device_id*,
                          cl_uint*) {
  return CL_DEVICE_PARTITION_FAILED;
}

}  // namespace

extern "C" cl_int clGetLayerInfo(cl_layer_info what, size_t size, void* value, size_t* size_needed) {
  constexpr cl_layer_api_version version = CL_LAYER_API_VERSION_100;
  if (what != CL_LAYER_API_VERSION || (value != nullptr && size < sizeof version)) return CL_INVALID_VALUE;
  if (value != nullptr) std::memcpy(value, &version, sizeof version);
  if (size_needed != nullptr) *size_needed = sizeof version;
  return CL_SUCCESS;
}

extern "C" cl_int clInitLayer(cl_uint entries, const cl_icd_dispatch* below, cl_uint* own_entries,
                              const cl_icd_dispatch** own) {
  std::memcpy(&calls, below, std::min(entries * sizeof(void*), sizeof calls));
  calls.clCreateSubDevices = refuse;
  *own = &calls;
  *own_entries = sizeof calls / sizeof(void*);
  return CL_SUCCESS;
}
