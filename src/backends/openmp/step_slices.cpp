// Steps of one stage, and the choice by stages. Those of more stages are apart: together they take long to
// compile. Compiled once per instruction set: hwy/foreach_target.h includes this file again for each.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/openmp/step_slices.cpp"
#include "backends/openmp/step_slices.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "backends/openmp/slice_steps-inl.h"
#include "backends/openmp/step_slices_of_many_stages.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {
SliceKernel slice_kernel_of_one_stage() {
  return {vector_nodes, hwy::TargetName(HWY_TARGET), exact_roots, fuses, &step_slices<1, 1>};
}
}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(slice_kernel_of_one_stage);
std::vector<SliceKernel> slice_kernels(const Integrator& integrator) {
  return integrator.stage_count == 1
             ? kernels_of_this_processor(HWY_DISPATCH_TABLE(slice_kernel_of_one_stage))
             : slice_kernels_of_many_stages();
}
}  // namespace mssim
#endif
