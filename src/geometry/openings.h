#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/surface.h"

namespace mssim {

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

}  // namespace mssim
