#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/box.h"
#include "geometry/surface.h"

namespace mssim {

/// The triangles of a closed surface in a tree of boxes, which finds the nearest of them and those on a line
/// without visiting them all. Immutable: threads may ask it at the same time.
class TriangleTree {
 public:
  /// `surface` has at least one triangle, and none without area.
  explicit TriangleTree(const Surface& surface);

  const Box<double>& box() const { return nodes_.front().box; }

  /// Distance from the nearest point of the nearest triangle, m, when it is less than `limit`, else `limit`.
  double distance(const Vec3d& point, double limit) const;

  /// How often the surface goes round the point: +1 for a triangle that faces +x and that the ray from the
  /// point to +x meets, -1 for one that faces -x. Nothing when rounding may have changed the sign of a
  /// determinant that decides: the ray, or the point, is as near an edge, a vertex or a plane as that.
  std::optional<int> winding_by_ray(const Vec3d& point) const;

  /// The same from the sum of the solid angles of all triangles (Van Oosterom and Strackee, "The solid angle
  /// of a plane triangle", 1983), which knows no special positions but is slow. The point lies on no
  /// triangle.
  int winding_by_angles(const Vec3d& point) const;

 private:
  using Triangle = std::array<Vec3d, 3>;
  struct Node {
    Box<double> box;
    std::uint32_t first = 0;  ///< a leaf: its first triangle; else the second child, the first stands behind
    std::uint32_t count = 0;  ///< triangles of a leaf; 0: not a leaf
  };
  void build(std::uint32_t first, std::uint32_t end);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace mssim
