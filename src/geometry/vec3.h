#pragma once

#include <cmath>

namespace mssim {

/// A vector in space; y points up. Units are given where a Vec3 is declared.
template <class Real>
struct Vec3 {
  Real x{}, y{}, z{};

  friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator*(Real s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
  constexpr Vec3& operator+=(const Vec3& a) { return *this = *this + a; }
  constexpr Vec3& operator-=(const Vec3& a) { return *this = *this - a; }
  constexpr bool operator==(const Vec3&) const = default;
};

/// Scalar and vector product.
template <class Real>
constexpr Real dot(const Vec3<Real>& a, const Vec3<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
constexpr Vec3<Real> cross(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The vector of double precision, its Euclidean length, and whether it has only finite components.
using Vec3d = Vec3<double>;

inline double length(const Vec3d& a) { return std::sqrt(dot(a, a)); }

inline bool is_finite(const Vec3d& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Converts a vector to another precision.
template <class To, class From>
constexpr Vec3<To> vec3_cast(const Vec3<From>& a) {
  return {static_cast<To>(a.x), static_cast<To>(a.y), static_cast<To>(a.z)};
}

}  // namespace mssim
