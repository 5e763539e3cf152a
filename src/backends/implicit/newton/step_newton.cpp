// Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/implicit/newton/step_newton.cpp"
#include "backends/implicit/newton/step_newton.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "backends/implicit/newton/team_equation-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
NewtonKernel newton_kernel() {
  return {lane_count(), hwy::TargetName(HWY_TARGET), exact_roots, &take_steps<NodeRows>,
          &take_steps<NodeSlices>};
}
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(newton_kernel);
std::vector<NewtonKernel> newton_kernels() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(newton_kernel));
}
}  // namespace mssim
#endif
