#include "mesh/box_shape.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "geometry/geometry.h"
#include "mesh/shape_checks.h"

namespace mssim {
namespace {

using Index = std::array<std::uint32_t, 3>;

/// Numbers the surface points of the grid of corners in the order of their first use.
class SurfacePoints {
 public:
  SurfacePoints(const BoxShape& box, Surface& surface) : box_(box), surface_(surface) {}

  std::uint32_t operator[](const Index& at) {
    const auto& cells = box_.cells;
    const std::uint32_t corner = (at[0] * (cells[1] + 1) + at[1]) * (cells[2] + 1) + at[2];
    const auto [entry, is_new] =
        number_.try_emplace(corner, static_cast<std::uint32_t>(surface_.points.size()));
    if (is_new) {
      const auto coordinate = [&](std::size_t axis, double size) {
        return size * (at[axis] / static_cast<double>(cells[axis]) - 0.5);
      };
      surface_.points.push_back(
          rounded({coordinate(0, box_.size.x), coordinate(1, box_.size.y), coordinate(2, box_.size.z)}));
    }
    return entry->second;
  }

 private:
  const BoxShape& box_;
  Surface& surface_;
  std::unordered_map<std::uint32_t, std::uint32_t> number_;  ///< by the corner's place in the grid
};

}  // namespace

std::uint64_t surface_point_count(const BoxShape& box) {
  const std::uint64_t a = box.cells[0], b = box.cells[1], c = box.cells[2];
  return 2 * (a * b + b * c + c * a) + 2;
}

Surface surface_of(const BoxShape& box) {
  require_length(box.size.x, "a box's size along x");
  require_length(box.size.y, "a box's size along y");
  require_length(box.size.z, "a box's size along z");
  for (const std::uint32_t cells : box.cells) require_cells(cells, 1, "a box's cells along a side");

  Surface surface;
  SurfacePoints points(box, surface);
  for (std::size_t normal = 0; normal < 3; ++normal) {
    const std::size_t right = (normal + 1) % 3;
    const std::size_t up = (normal + 2) % 3;
    for (const bool far_side : {false, true})
      for (std::uint32_t r = 0; r < box.cells[right]; ++r)
        for (std::uint32_t u = 0; u < box.cells[up]; ++u) {
          const auto corner = [&](std::uint32_t to_right, std::uint32_t to_up) {
            Index at{};
            at[normal] = far_side ? box.cells[normal] : 0;
            at[right] = r + to_right;
            at[up] = u + to_up;
            return points[at];
          };
          // (right, up, normal) is right-handed: counter-clockwise seen from the far side.
          std::array<std::uint32_t, 4> square{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
          if (!far_side) std::swap(square[1], square[3]);
          surface.triangles.push_back({square[0], square[1], square[2]});
          surface.triangles.push_back({square[0], square[2], square[3]});
        }
  }
  return surface;
}

double depth_in(const BoxShape& box, const Vec3d& point) {
  return std::min({box.size.x / 2 - std::abs(point.x), box.size.y / 2 - std::abs(point.y),
                   box.size.z / 2 - std::abs(point.z)});
}

}  // namespace mssim
