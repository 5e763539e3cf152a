#include "garment/contact/side_map.h"

#include <cstddef>
#include <limits>

namespace mssim {

SideMap side_map(const Surface& surface, const std::vector<Vec3d>& normals, const PixelGrid& grid,
                 ViewFrom view, int threads) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::vector<Fragment> fragments = rasterise(surface, grid, view, threads);
  SideMap map{std::vector<double>(fragments.size(), view == ViewFrom::front ? -infinity : infinity),
              std::vector<Vec3d>(fragments.size())};
  for (std::size_t pixel = 0; pixel < fragments.size(); ++pixel) {
    const Fragment& fragment = fragments[pixel];
    if (fragment.triangle == Fragment::nothing) continue;
    map.depth[pixel] = fragment.z;
    Vec3d sum;
    for (std::size_t corner = 0; corner < 3; ++corner)
      sum += double{fragment.weights[corner]} * normals[surface.triangles[fragment.triangle][corner]];
    if (const double size = length(sum); size > 0) map.normal[pixel] = (1 / size) * sum;
  }
  return map;
}

}  // namespace mssim
