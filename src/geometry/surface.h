#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "geometry/vec3.h"

namespace mssim {

/// A closed surface of triangles. Seen from outside, the points of a triangle are counter-clockwise.
struct Surface {
  std::vector<Vec3d> points;  ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Numbers the points of a surface by keys: a key used again has the same point.
template <class Key>
class PointNumbers {
 public:
  /// `surface` gets the points; it must outlive this object.
  explicit PointNumbers(Surface& surface) : surface_(surface) {}

  /// The number of the key's point, which position() gives if the key is new.
  template <class Position>
  std::uint32_t of(const Key& key, Position position) {
    const auto [entry, is_new] = number_.try_emplace(key, static_cast<std::uint32_t>(surface_.points.size()));
    if (is_new) surface_.points.push_back(position());
    return entry->second;
  }

 private:
  Surface& surface_;
  std::map<Key, std::uint32_t> number_;
};

/// Throws InputError, which begins with `name`, unless the surface encloses a volume as far as the joins of
/// its triangles show: finite points, all of them used, indices in range, no triangle without area, every
/// edge in exactly two triangles of opposite direction, positive volume. Several separate closed parts are
/// allowed. TetGen later finds triangles that cross each other.
void validate_surface(const Surface& surface, std::string_view name);

/// The enclosed volume, m^3; negative if the triangles point inwards.
double volume_of(const Surface& surface);

/// The connected parts of a closed surface: triangles that share a point are in one part. Each part keeps the
/// order of its triangles and points; parts are ordered by their first triangles. A part that points inwards
/// (negative volume) is reversed, so all parts face outwards.
std::vector<Surface> closed_parts(const Surface& surface);

/// The surface with its parts all facing outwards.
Surface facing_outwards(const Surface& surface);

/// A hole in a surface: a chain of edges that belong to one triangle each.
struct Opening {
  std::vector<std::uint32_t> points;  ///< in the orientation of the adjacent triangles
  bool is_ring = true;                ///< the last point is joined to the first; else orientations disagree
  Vec3d centre;                       ///< mean of its edges, weighted by length
  double size = 0;  ///< m, largest distance between points; of over 3,000, twice that from the centre

  std::size_t edges() const { return is_ring ? points.size() : points.size() - 1; }
};

/// Merges corners of triangles that differ in their last digits, as exporters write them. Candidates are
/// points on edges of one triangle only, within a hundred-thousandth of the surface's longest extent, the
/// nearest first, but never two of one triangle. A closed surface is unchanged. Returns the number of merged
/// points.
std::size_t join_corners(Surface& surface);

/// Throws InputError if most edges belong to one triangle only: then openings between triangles are no holes.
void require_joined(const Surface& surface);

/// All openings, the largest first. Openings that touch at a point are separate; none has a point twice.
std::vector<Opening> openings_of(const Surface& surface);

/// Fills openings up to `largest`, m, with a fan of triangles each, and returns them. Throws InputError, with
/// place and size, for a larger opening and for one whose edges form no ring, and what require_joined throws.
std::vector<Opening> close_openings(Surface& surface, double largest);

/// Fills all openings of a part of a closed surface with triangles between the points of their rings, each
/// time cutting off the corner with the shortest new edge. The patch follows a ring around a body, where the
/// centre of a fan would be deep inside or in front of it.
void span_openings(Surface& surface);

/// Unit normals of the surface's points, pointing outwards: the sum of the normals of the triangles around a
/// point, each weighted with the triangle's angle there (Thürmer and Wüthrich, "Computing vertex normals from
/// polygonal facets", 1998). They do not depend on how flat polygons are cut into triangles. If the sum
/// vanishes, the normal is (0, 0, 0).
std::vector<Vec3d> vertex_normals(const Surface& surface);

/// The surface with every point moved by `offset` (m, negative: inwards) along its normal.
Surface inflated(const Surface& surface, const std::vector<Vec3d>& normals, double offset);

}  // namespace mssim
