#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/surface.h"
#include "mesh/tet_mesh.h"

namespace mssim {

/// TetGen's switches that fill a surface and keep it as it is.
inline constexpr const char* keep_surface = "-pY";

/// The mesh that TetGen makes of a valid surface (validate_surface) and points inside it, from the cache when
/// it was made before; its nodes are the surface's points, then the interior points, then TetGen's own. Where
/// TetGen is not installed, a mesh that one made earlier is taken. `added_points` is
/// how many TetGen will add by itself at least. Throws what run_tetgen and require_meshing_memory throw, and
/// MissingProgram when TetGen is needed and not installed.
TetMesh tetrahedralise(const Surface& surface, const std::vector<Vec3d>& interior,
                       const std::string& switches, std::uint64_t added_points = 0);

}  // namespace mssim
