// Steps of many stages. They are apart from the others because both together take long to compile.
// Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/openmp/step_bands_of_many_stages.cpp"
#include "backends/openmp/step_bands_of_many_stages.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "backends/openmp/band_steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
BandKernel many_stages_kernel() {
  return {lane_count(), hwy::TargetName(HWY_TARGET), exact_roots, &step_bands<few_stages + 1, max_stages>};
}
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(many_stages_kernel);
std::vector<BandKernel> kernels_of_many_stages() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(many_stages_kernel));
}
}  // namespace mssim
#endif
