#include "geometry/surface_sides.h"

#include <algorithm>
#include <tuple>

namespace mssim {

std::vector<SurfaceSide> sides_by_edge(const Surface& surface) {
  std::vector<SurfaceSide> sides;
  sides.reserve(3 * surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t from = surface.triangles[t][corner];
      const std::uint32_t to = surface.triangles[t][(corner + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), from < to, t});
    }
  std::sort(sides.begin(), sides.end(), [](const SurfaceSide& a, const SurfaceSide& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return sides;
}

std::span<const SurfaceSide> sides_of_edge(std::span<const SurfaceSide> sides, std::size_t first) {
  std::size_t end = first + 1;
  while (end < sides.size() && sides[end].low == sides[first].low && sides[end].high == sides[first].high)
    ++end;
  return sides.subspan(first, end - first);
}

}  // namespace mssim
