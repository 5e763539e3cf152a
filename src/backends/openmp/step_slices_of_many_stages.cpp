// Steps of more than one stage.
// Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/openmp/step_slices_of_many_stages.cpp"
#include "backends/openmp/step_slices_of_many_stages.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "backends/openmp/slice_steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
SliceKernel slice_kernel_of_many_stages() {
  return {vector_nodes, hwy::TargetName(HWY_TARGET), exact_roots, fuses, &step_slices<2, max_stages>};
}
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(slice_kernel_of_many_stages);
std::vector<SliceKernel> slice_kernels_of_many_stages() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(slice_kernel_of_many_stages));
}
}  // namespace mssim
#endif
