#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace mssim {

/// Node indices a, b, c, d of a tetrahedron of positive volume: (b - a) . ((c - a) x (d - a)) > 0.
using Tetrahedron = std::array<std::uint32_t, 4>;

/// The solid bodies of a scene, one after the other. The springs are the edges of the tetrahedra.
struct TetrahedralMesh {
  std::vector<Tetrahedron> tetrahedra;
};

}  // namespace mssim
