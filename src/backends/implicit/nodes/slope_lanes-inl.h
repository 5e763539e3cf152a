// Compiled once per instruction set, so the guard toggles.
#if defined(MSSIM_SLOPE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_SLOPE_LANES_INL_H_
#undef MSSIM_SLOPE_LANES_INL_H_
#else
#define MSSIM_SLOPE_LANES_INL_H_
#endif

#include "backends/vectors/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// What a field of slopes holds of each spring: from which kernels/spring_jacobian.h makes its Jacobian.
struct SlopeLanes {
  Lanes3 n;      ///< unit vector along the spring, either way; zero where there is no spring
  Lanes across;  ///< as spring_jacobian_times() takes it
};
template <class Exists>
HWY_INLINE SlopeLanes keep(Exists exists, const SlopeLanes& slope) {
  return {keep(exists, slope.n), keep(exists, slope.across)};
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
