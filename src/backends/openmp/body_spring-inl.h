// A spring of bodies, one a lane: the same operations for every layout of bodies, so that their bits are the
// same. Compiled once per instruction set, so the guard toggles.
#if defined(MSSIM_BODY_SPRING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_BODY_SPRING_INL_H_
#undef MSSIM_BODY_SPRING_INL_H_
#else
#define MSSIM_BODY_SPRING_INL_H_
#endif

#include "backends/layouts/spring_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// spring_pull (kernels/spring_law.h) between nodes `to_other` apart (m), the other one moving by `closing`
/// against this one (m/s). Finite also where there is no spring and both ends are the same node: 1e-36 is
/// added to the length squared. Elsewhere that can only decide a tie; a spring of length zero gives no force,
/// where serial's gives NaN.
HWY_INLINE Lanes body_spring_pull(const Lanes3& to_other, const Lanes3& closing, const SpringLanes& spring) {
  return spring_pull_at(inverse_length(dot_add(to_other, to_other, Lanes(1e-36F))), dot(closing, to_other),
                        spring.stiffness, spring.stiffness_rest, spring.damping);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
