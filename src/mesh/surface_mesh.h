#pragma once

#include <filesystem>

#include "mesh/tet_mesh.h"

namespace mssim {

/// A body whose surface a user drew.
struct SurfaceShape {
  std::filesystem::path file;    ///< .obj or .stl
  double unit_m = 1;             ///< metres in one unit of the file; 0.001 for a drawing in millimetres
  double largest_volume_m3 = 0;  ///< no tetrahedron may be larger; 0 for no limit
};

/// The mesh of such a body: TetGen adds nodes, inside and on the surface, until the tetrahedra are well
/// shaped and small enough; the shape stays. From the cache when it was made before. Throws InputError, which
/// names the file, for one that cannot be read, encloses no body or is too thin to be
/// filled, and for numbers out of range;
/// MissingProgram when TetGen is needed and not installed.
TetMesh surface_mesh(const SurfaceShape& body);

}  // namespace mssim
