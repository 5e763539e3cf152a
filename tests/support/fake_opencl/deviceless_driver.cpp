// An OpenCL driver that offers no device, as one whose hardware is missing.
#include "fake_driver.h"

cl_int CL_API_CALL fake_opencl::device_ids(cl_platform_id, cl_device_type, cl_uint, cl_device_id*, cl_uint*) {
  return CL_DEVICE_NOT_FOUND;
}
