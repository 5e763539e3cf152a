#pragma once

#include <cmath>

#include "geometry/vec3.h"
#include "kernels/spring_constants.h"

namespace mssim {

/// The laws of kernels/ for one node at a time on the host: Real is float or double. Code that handles
/// several nodes in one vector register instantiates the same texts on its own.

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
inline Real square_root(Real a) {
  return std::sqrt(a);
}

template <class Real>
inline Real inverse_sqrt(Real a) {
  return Real{1} / std::sqrt(a);
}

template <class Real>
inline Real where_less(Real a, Real b, Real yes, Real no) {
  return a < b ? yes : no;
}

#define MSSIM_LAW_INLINE inline
#include "laws/laws-inl.h"

template <class Real>
inline bool operator==(const SpringConstants<Real>& a, const SpringConstants<Real>& b) {
  bool equal = true;
#define MSSIM_COMPARE(name) equal = equal && a.name == b.name;
  MSSIM_SPRING_CONSTANTS(MSSIM_COMPARE)
#undef MSSIM_COMPARE
  return equal;
}

/// Puts a node that has fallen below y = height (m) back onto the floor and changes its velocity as
/// kernels/node_laws.h says; a node above it stays as it is. `x` in m, `v` in m/s.
template <class Real>
inline void touch_floor(Vec3<Real>& x, Vec3<Real>& v, Real height, Real restitution, Real friction) {
  if (!(x.y < height)) return;
  x.y = height;
  v = floor_velocity(v, restitution, friction);
}

/// The way from a joint's node to the point that it is sewn to: kernels/garment_laws.h for vectors.
template <class Real>
inline Vec3<Real> joint_gap(const Vec3<Real>& node, const Vec3<Real>& first, const Vec3<Real>& second,
                            Real fraction) {
  return {joint_gap(node.x, first.x, second.x, fraction), joint_gap(node.y, first.y, second.y, fraction),
          joint_gap(node.z, first.z, second.z, fraction)};
}

}  // namespace mssim
