// Compiled once per instruction set, so the guard toggles.
#if defined(MSSIM_SPRING_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_SPRING_LANES_INL_H_
#undef MSSIM_SPRING_LANES_INL_H_
#else
#define MSSIM_SPRING_LANES_INL_H_
#endif

#include "backends/layouts/spring_constants.h"
#include "backends/vectors/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// Spring constants in registers.
struct SpringLanes {
  Lanes stiffness, stiffness_rest, damping;
  HWY_INLINE SpringLanes(Lanes k, Lanes k_rest, Lanes c) : stiffness(k), stiffness_rest(k_rest), damping(c) {}
  HWY_INLINE explicit SpringLanes(const SpringConstants& s)
      : stiffness(s.stiffness), stiffness_rest(s.stiffness_rest), damping(s.damping) {}
};

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
