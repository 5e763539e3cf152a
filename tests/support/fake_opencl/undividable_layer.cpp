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
  std::memcpy(&calls, target_dispatch, std::min(num_entries * sizeof(void*), sizeof calls));
  calls.clCreateSubDevices = refuse;
  *layer_dispatch_ret = &calls;
  *num_entries_ret = sizeof calls / sizeof(void*);
  return CL_SUCCESS;
}
