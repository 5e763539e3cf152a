#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "integrators/coefficients.h"
#include "model/vec3.h"

namespace mssim {

/// The shared laws and the integrator table's lines for one node at a time on the host: Real is float or
/// double, a vector is a Vec3<Real>. Code that handles several nodes in one vector register instantiates the
/// same three texts on its own.

/// a * b + c, in two roundings: a fused one would be a library call on processors without the instruction.
template <class Real>
inline Real mul_add(Real a, Real b, Real c) {
  return a * b + c;
}
template <class Real>
inline Vec3<Real> mul_add(Real a, const Vec3<Real>& b, const Vec3<Real>& c) {
  return a * b + c;
}

template <class Real>
inline Real inverse_sqrt(Real a) {
  return Real{1} / std::sqrt(a);
}

template <class Real>
inline Real where_less(Real a, Real b, Real yes, Real no) {
  return a < b ? yes : no;
}

#define MSSIM_LAW       \
  template <class Real> \
  inline Real
#include "kernels/floor_law.h"
#include "kernels/spring_law.h"
#undef MSSIM_LAW

#define MSSIM_INLINE [[gnu::always_inline]] inline
#define MSSIM_INLINE_LAMBDA __attribute__((always_inline))
#include "integrators/stage_update-inl.h"
#undef MSSIM_INLINE
#undef MSSIM_INLINE_LAMBDA

/// Puts a node that has fallen below y = height (m) back onto the floor and changes its velocity as
/// kernels/floor_law.h says; a node above it stays as it is. `x` in m, `v` in m/s.
template <class Real>
inline void touch_floor(Vec3<Real>& x, Vec3<Real>& v, Real height, Real restitution, Real friction) {
  if (!(x.y < height)) return;
  x.y = height;
  const Real rebound = floor_rebound(v.y, restitution);
  const Real grip = floor_grip(rebound - v.y, v.x * v.x + v.z * v.z, friction);
  v = {grip * v.x, rebound, grip * v.z};
}

}  // namespace mssim
