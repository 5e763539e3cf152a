#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/geometry.h"
#include "geometry/surface.h"
#include "geometry/vec3.h"

namespace mssim {

/// The point of a triangle nearest to a given point.
struct NearestPoint {
  std::array<float, 3> weight{};  ///< barycentric, none negative; their sum is 1
  Vec3<float> offset;             ///< m, from the nearest point to the given one

  float distance_squared() const { return dot(offset, offset); }
};

/// The point of the triangle a, b, c nearest to p (Ericson, "Real-Time Collision Detection", 2005, 5.1.5). On
/// an edge the third weight is exactly 0, at a corner the two others are. If the triangle has no area, the
/// result is a point of its edges.
inline NearestPoint nearest_point(const Vec3<float>& p, const Vec3<float>& a, const Vec3<float>& b,
                                  const Vec3<float>& c) {
  const Vec3<float> ab = b - a, ac = c - a, ap = p - a;
  // For an edge without length, its first point.
  const auto fraction = [](float part, float whole) { return whole > 0 ? part / whole : 0; };
  // Relative to a: differences of neighbours are small, and so are their rounding errors.
  const auto at = [&](float of_b, float of_c) {
    const float of_a = std::max(1 - of_b - of_c, 0.0F);
    return NearestPoint{{of_a, of_b, of_c}, ap - (of_b * ab + of_c * ac)};
  };
  const float ap_ab = dot(ab, ap), ap_ac = dot(ac, ap);
  if (ap_ab <= 0 && ap_ac <= 0) return at(0, 0);
  const Vec3<float> bp = p - b;
  const float bp_ab = dot(ab, bp), bp_ac = dot(ac, bp);
  if (bp_ab >= 0 && bp_ac <= bp_ab) return at(1, 0);
  const float area_c = ap_ab * bp_ac - bp_ab * ap_ac;
  if (area_c <= 0 && ap_ab >= 0 && bp_ab <= 0) return at(fraction(ap_ab, ap_ab - bp_ab), 0);
  const Vec3<float> cp = p - c;
  const float cp_ab = dot(ab, cp), cp_ac = dot(ac, cp);
  if (cp_ac >= 0 && cp_ab <= cp_ac) return at(0, 1);
  const float area_b = cp_ab * ap_ac - ap_ab * cp_ac;
  if (area_b <= 0 && ap_ac >= 0 && cp_ac <= 0) return at(0, fraction(ap_ac, ap_ac - cp_ac));
  const float area_a = bp_ab * cp_ac - cp_ab * bp_ac;
  const float along_b = bp_ac - bp_ab, along_c = cp_ab - cp_ac;
  if (area_a <= 0 && along_b >= 0 && along_c >= 0) {
    const float of_c = fraction(along_b, along_b + along_c);
    NearestPoint nearest = at(1 - of_c, of_c);
    nearest.weight[0] = 0;  // 1 - (1 - c) - c may not be 0
    return nearest;
  }
  const float whole = area_a + area_b + area_c;
  return at(fraction(area_b, whole), fraction(area_c, whole));
}

/// The triangles of a closed surface in a tree of boxes, for searching the nearest triangle and those on a
/// line without visiting all. Immutable: threads may share it.
class TriangleTree {
 public:
  /// `surface` must have at least one triangle, and none without area.
  explicit TriangleTree(const Surface& surface);

  const Box<double>& box() const { return nodes_.front().box; }

  /// Distance from the nearest point of the surface, m, or `limit` if it is not less than that.
  double distance(const Vec3d& point, double limit) const;

  /// Winding number of the surface around the point: +1 for a triangle that faces +x and intersects the ray
  /// from the point towards +x, -1 for one that faces -x. Nothing if rounding may have changed the sign of a
  /// determinant: the ray or the point is too near an edge, a vertex or a plane.
  std::optional<int> winding_by_ray(const Vec3d& point) const;

  /// The winding number from the sum of the solid angles of all triangles (Van Oosterom and Strackee, "The
  /// solid angle of a plane triangle", 1983). It has no special cases but is slow. The point must not lie on
  /// a triangle.
  int winding_by_angles(const Vec3d& point) const;

 private:
  using Triangle = std::array<Vec3d, 3>;
  struct Node {
    Box<double> box;
    std::uint32_t first = 0;  ///< a leaf's first triangle, or the second child (the first is the next node)
    std::uint32_t count = 0;  ///< triangles of a leaf; 0: not a leaf
  };
  void build(std::uint32_t first, std::uint32_t end);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace mssim
