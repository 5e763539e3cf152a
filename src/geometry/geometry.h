#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "geometry/vec3.h"
#include "text/text.h"

namespace mssim {

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

/// The farthest that a mesh file may place a node, in the file's unit: volumes, and what is computed from
/// them in single precision, stay finite then, whatever the unit.
constexpr double farthest_coordinate = 1e9;
inline constexpr std::string_view coordinate_wanted = "give a number from -1e9 to 1e9";

/// Is it a number, and not too large?
inline bool is_coordinate(double x) { return std::abs(x) <= farthest_coordinate; }

/// A number for messages that has been computed, without the last digits, which rounding has made.
std::string shown(double computed);

/// "(x, y, z)" for messages.
std::string place(const Vec3d& point);

}  // namespace mssim
