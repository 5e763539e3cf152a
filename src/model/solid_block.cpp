#include "model/solid_block.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>

namespace mssim {

void add_block(SolidBlock& blocks, std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, double spacing,
               const Vec3d& corner) {
  const auto first = static_cast<std::uint32_t>(blocks.position.size());
  for (std::uint32_t z = 0; z < nz; ++z)
    for (std::uint32_t y = 0; y < ny; ++y)
      for (std::uint32_t x = 0; x < nx; ++x)
        blocks.position.push_back(corner + Vec3d{x * spacing, y * spacing, z * spacing});
  const auto node = [&](std::array<std::uint32_t, 3> at) {
    return first + (at[2] * ny + at[1]) * nx + at[0];
  };
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::uint32_t z = 0; z + 1 < nz; ++z)
    for (std::uint32_t y = 0; y + 1 < ny; ++y)
      for (std::uint32_t x = 0; x + 1 < nx; ++x) {
        std::array<std::size_t, 3> axes{0, 1, 2};
        do {  // the six ways from the cube's first corner to its last along edges
          std::array<std::uint32_t, 3> at{x, y, z};
          Tetrahedron corners{node(at)};
          for (std::size_t i = 0; i < 3; ++i) {
            ++at[axes[i]];
            corners[i + 1] = node(at);
          }
          const bool even = axes[0] == 0 ? axes[1] == 1 : axes[0] == 1 ? axes[1] == 2 : axes[1] == 0;
          if (!even) std::swap(corners[1], corners[2]);
          blocks.tetrahedra.push_back(corners);
          for (std::size_t a = 0; a < 4; ++a)
            for (std::size_t b = a + 1; b < 4; ++b) edges.insert(std::minmax(corners[a], corners[b]));
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  blocks.edges.insert(blocks.edges.end(), edges.begin(), edges.end());
}

}  // namespace mssim
