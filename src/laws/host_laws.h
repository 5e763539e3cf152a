#pragma once

#include <array>
#include <bit>
#include <cmath>

#include "geometry/vec3.h"
#include "kernels/spring_constants.h"

namespace mssim {

/// The laws of kernels/ for one node at a time on the host: Real is float or double. Vector code instantiates
/// the same texts itself.

/// a * b + c with two roundings: a fused one would be a library call on CPUs without the instruction.
template <class Real>
inline Real mul_add(Real a, Real b, Real c) {
  return a * b + c;
}
template <class Real>
inline Vec3<Real> mul_add(Real a, const Vec3<Real>& b, const Vec3<Real>& c) {
  return a * b + c;
}

/// The functions that the laws need for a number, each operation correctly rounded.
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

/// The constants in the order of their table.
template <class Real>
inline std::array<Real, spring_constant_count> numbers_of(const SpringConstants<Real>& constants) {
  return std::bit_cast<std::array<Real, spring_constant_count>>(constants);
}

template <class Real>
inline bool operator==(const SpringConstants<Real>& a, const SpringConstants<Real>& b) {
  return numbers_of(a) == numbers_of(b);
}

/// Puts a node that has fallen below y = height (m) back on the floor and changes its velocity as in
/// kernels/node_laws.h; a node above stays unchanged. `x` in m, `v` in m/s.
template <class Real>
inline void touch_floor(Vec3<Real>& x, Vec3<Real>& v, Real height, Real restitution, Real friction) {
  if (!(x.y < height)) return;
  x.y = height;
  v = floor_velocity(v, restitution, friction);
}

/// Vector from a joint's node to the point that it is sewn to: kernels/garment_laws.h for Vec3.
template <class Real>
inline Vec3<Real> joint_gap(const Vec3<Real>& node, const Vec3<Real>& first, const Vec3<Real>& second,
                            Real fraction) {
  return {joint_gap(node.x, first.x, second.x, fraction), joint_gap(node.y, first.y, second.y, fraction),
          joint_gap(node.z, first.z, second.z, fraction)};
}

}  // namespace mssim
