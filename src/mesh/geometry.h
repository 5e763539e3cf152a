#pragma once

#include <cmath>
#include <string>

#include "model/vec3.h"

namespace mssim {

template <class Real>
constexpr Vec3<Real> cross(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline double length(const Vec3d& a) { return std::sqrt(dot(a, a)); }

inline bool is_finite(const Vec3d& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Six times the volume of the tetrahedron a, b, c, d; positive in the orientation of Tetrahedron.
constexpr double six_volumes(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return dot(b - a, cross(c - a, d - a));
}

/// The point rounded to whole micrometres: what libm's last bit says about a sine then changes no mesh.
inline Vec3d rounded(const Vec3d& point) {
  constexpr double per_metre = 1e6;
  // Adding zero turns -0 into 0, which would be another text for the same place.
  const auto round_one = [](double x) { return std::round(x * per_metre) / per_metre + 0.0; };
  return {round_one(point.x), round_one(point.y), round_one(point.z)};
}

/// The shortest decimal text that reads back as the same number, in every locale.
std::string decimal(double value);

/// A number for messages that has been computed, without the last digits, which rounding has made.
std::string shown(double computed);

/// "(x, y, z)" for messages.
std::string place(const Vec3d& point);

}  // namespace mssim
