#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "garment/contact/body_maps.h"
#include "tests/support/contact_fixture.h"

namespace mssim {

constexpr double micrometre = 1e-6;  ///< to which the shapes' points are rounded
constexpr double pixel = 0.0025;

/// The sphere around the origin that a mesh approximates, and how well.
struct MeshOfSphere {
  double radius;
  double shell;  ///< m, how far inside the sphere the mesh reaches
  /// Largest angle between a triangle's normal and the sphere's at its corners: the corners lie on the circle
  /// that the triangle's plane cuts out.
  double angle;

  MeshOfSphere(const Surface& mesh, double radius_)
      : radius(radius_), shell(radius - enclosed_radius(mesh)), angle(std::acos(1 - shell / radius)) {}
  /// Between the sphere's normal at a point of the mesh and the interpolated one: the point's direction, the
  /// triangle's normal, its corners' directions and the normals of the triangles around those, whose positive
  /// combination it is, are at most `angle` apart each.
  double normal_error() const { return 3 * angle; }
};

inline double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

template <class Value>
bool same_bits(const Value& a, const Value& b) {
  using Words = std::array<std::uint32_t, sizeof(Value) / sizeof(std::uint32_t)>;
  return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
}

inline bool same_bits(const BodyMaps& a, const BodyMaps& b) {
  return same_bits(a.frame(), b.frame()) &&
         std::equal(a.pixels().begin(), a.pixels().end(), b.pixels().begin(), b.pixels().end(),
                    [](const BodyPixel& p, const BodyPixel& q) { return same_bits(p, q); });
}

}  // namespace mssim
