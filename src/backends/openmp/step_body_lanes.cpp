// Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/openmp/step_body_lanes.cpp"
#include "backends/openmp/step_body_lanes.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "backends/openmp/body_lane_steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
BodyLanesKernel body_lanes_kernel() {
  return {vector_nodes, hwy::TargetName(HWY_TARGET), exact_roots, &step_body_lanes};
}
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(body_lanes_kernel);
std::vector<BodyLanesKernel> body_lanes_kernels() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(body_lanes_kernel));
}
}  // namespace mssim
#endif
