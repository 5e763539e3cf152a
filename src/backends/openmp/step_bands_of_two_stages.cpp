// Steps of two stages.
// Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/openmp/step_bands_of_two_stages.cpp"
#include "backends/openmp/step_bands_of_two_stages.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "backends/openmp/band_steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
BandKernel band_kernel_of_two_stages() {
  return {lane_count(), hwy::TargetName(HWY_TARGET), exact_roots, fuses, &step_bands<2, 2>};
}
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(band_kernel_of_two_stages);
std::vector<BandKernel> band_kernels_of_two_stages() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(band_kernel_of_two_stages));
}
}  // namespace mssim
#endif
