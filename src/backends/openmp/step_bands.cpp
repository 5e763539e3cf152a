// Steps of few stages, and the table of kernels.
// Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/openmp/step_bands.cpp"
#include "backends/openmp/step_bands.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "backends/openmp/band_steps-inl.h"
#include "backends/openmp/step_bands_of_many_stages.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
BandKernel few_stages_kernel() {
  return {lane_count(), hwy::TargetName(HWY_TARGET), exact_roots, &step_bands<1, few_stages>};
}
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(few_stages_kernel);
std::vector<BandKernel> band_kernels(const Integrator& integrator) {
  return integrator.stage_count > few_stages
             ? kernels_of_many_stages()
             : kernels_of_this_processor(HWY_DISPATCH_TABLE(few_stages_kernel));
}
}  // namespace mssim
#endif
