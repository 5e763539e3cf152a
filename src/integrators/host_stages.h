#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "geometry/vec3.h"
#include "integrators/coefficients.h"
#include "laws/host_laws.h"

namespace mssim {

/// The integrator table's assignments and the floor for one node at a time on the host: Real is float or
/// double, a vector is a Vec3<Real>. Code that handles several nodes in one vector register has its own.

#define MSSIM_INLINE [[gnu::always_inline]] inline
#define MSSIM_INLINE_LAMBDA __attribute__((always_inline))
#include "integrators/stage_update-inl.h"
#undef MSSIM_INLINE
#undef MSSIM_INLINE_LAMBDA

/// Puts a node that has fallen below y = height (m) back onto the floor and changes its velocity as
/// kernels/node_laws.h says; a node above it stays as it is. `x` in m, `v` in m/s.
template <class Real>
inline void touch_floor(Vec3<Real>& x, Vec3<Real>& v, Real height, Real restitution, Real friction) {
  if (!(x.y < height)) return;
  x.y = height;
  v = floor_velocity(v, restitution, friction);
}

}  // namespace mssim
