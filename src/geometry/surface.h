#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "geometry/vec3.h"

namespace mssim {

/// A closed surface of triangles. Seen from outside, the points of a triangle go round counter-clockwise.
struct Surface {
  std::vector<Vec3d> points;  ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Throws InputError, which begins with `name`, unless the surface encloses a volume as far as that can be
/// seen from how its triangles join: finite points, all of them used, indices in range, no triangle without
/// area, every edge in exactly two triangles that run along it in opposite directions, positive volume.
/// Several separate closed parts are allowed. Triangles that cross each other are found later, by TetGen.
void validate_surface(const Surface& surface, std::string_view name);

/// The enclosed volume, m^3; negative when the triangles point inwards.
double volume_of(const Surface& surface);

}  // namespace mssim
