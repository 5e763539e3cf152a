// Steps of one stage, and the choice by stages. Those of more stages are apart: together they take long to
// compile. Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/openmp/step_bands.cpp"
#include "backends/openmp/step_bands.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "backends/openmp/band_steps-inl.h"
#include "backends/openmp/step_bands_of_many_stages.h"
#include "backends/openmp/step_bands_of_two_stages.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
BandKernel band_kernel_of_one_stage() {
  return {lane_count(), hwy::TargetName(HWY_TARGET), exact_roots, fuses, &step_bands<1, 1>};
}
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(band_kernel_of_one_stage);
std::vector<BandKernel> band_kernels(const Integrator& integrator) {
  if (integrator.stage_count > 2) return band_kernels_of_many_stages();
  if (integrator.stage_count == 2) return band_kernels_of_two_stages();
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(band_kernel_of_one_stage));
}
}  // namespace mssim
#endif
