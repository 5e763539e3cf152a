#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
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

/// The connected parts of a closed surface: triangles that share a point belong to one. Each part keeps the
/// order of its triangles and points, and parts stand in the order of their first triangles. A part that
/// points inwards (its volume is negative) is turned round, so that outside is the same for all.
std::vector<Surface> closed_parts(const Surface& surface);

/// The parts as one surface again, all of them facing outwards.
Surface facing_outwards(const Surface& surface);

/// A hole in a surface: edges of one triangle each, one after the other.
struct Opening {
  std::vector<std::uint32_t> points;  ///< in the order in which the triangles beside them run
  bool is_ring = true;  ///< the last point is joined to the first; else triangles disagree there
  Vec3d centre;         ///< of the edges
  double size = 0;      ///< m, twice the largest distance of a point from the centre

  std::size_t edges() const { return is_ring ? points.size() : points.size() - 1; }
};

/// Corners of triangles that differ in their last digits, as exporters write them, become one: of points on
/// edges of one triangle only, those that lie within a hundred-thousandth of the surface's longest extent,
/// the nearest first, but never two of one triangle. A closed surface stays as it is. Returns how many points
/// were merged into others.
std::size_t join_corners(Surface& surface);

/// Throws InputError where most edges of several triangles belong to one only: there triangles do not join,
/// and openings between them are no holes.
void require_joined(const Surface& surface);

/// All of them, the largest first. Openings that touch in a point are told apart; none has a point twice.
std::vector<Opening> openings_of(const Surface& surface);

/// Fills the openings that are not larger than `largest`, m, with a fan of triangles each, and returns them.
/// Throws InputError, which says where and how large it is, for a larger one and for one whose edges make no
/// ring, and what require_joined throws.
std::vector<Opening> close_openings(Surface& surface, double largest);

/// Fills all openings of a part of a closed surface with triangles between the points of their rings, cutting
/// off the corner with the shortest new edge each time. The patch then follows a ring round a body, where a
/// fan's middle would lie deep within it or before it.
void span_openings(Surface& surface);

/// Unit normals of the surface's points, pointing out of the body: the sum of the normals of the triangles
/// around a point, each weighted with the triangle's angle there (Thürmer and Wüthrich, "Computing vertex
/// normals from polygonal facets", 1998). They do not depend on how flat polygons are cut into triangles.
/// Where the sum vanishes the normal is (0, 0, 0).
std::vector<Vec3d> vertex_normals(const Surface& surface);

/// The surface with every point moved by `offset` (m, inwards where negative) along its normal.
Surface inflated(const Surface& surface, const std::vector<Vec3d>& normals, double offset);

}  // namespace mssim
