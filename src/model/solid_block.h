#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/vec3.h"
#include "model/system.h"

namespace mssim {

/// Tetrahedra that need no mesher.
struct SolidBlock {
  std::vector<Vec3d> position;  ///< [nodes] m
  std::vector<Tetrahedron> tetrahedra;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  ///< of the tetrahedra, each once, ascending
};

/// Adds a block of nx x ny x nz nodes, `spacing` m apart, x fastest, from `corner` on: each cube of
/// neighbours cut into six tetrahedra around its diagonal (Kuhn's cut).
void add_block(SolidBlock& blocks, std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, double spacing,
               const Vec3d& corner);

}  // namespace mssim
