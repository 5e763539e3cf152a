#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/surface.h"
#include "mesh/shapes.h"
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

/// What a scene's author got from a mesh; another TetGen may give something else, which is then said, not
/// refused.
struct MeshSize {
  std::uint32_t nodes = 0;
  std::uint32_t springs = 0;  ///< unique edges

  bool operator==(const MeshSize&) const = default;
};

/// The shapes that mssim can make by itself.
using Shape = std::variant<BoxShape, SphereShape, TorusShape>;

/// Points that TetGen is given for a shape, counted without making them.
std::uint64_t point_count(const Shape& shape, const InteriorPoints& interior);

/// What TetGen is given for a shape: its surface and the points inside.
struct ShapePoints {
  Surface surface;
  std::vector<Vec3d> interior;
};
ShapePoints points_of(const Shape& shape, const InteriorPoints& interior);

/// The mesh of a shape: its surface points first, then the interior points, then what TetGen had to add
/// (nothing, for the bodies of the committed scenes). Made by TetGen or taken from the cache
/// (tetrahedralise). Throws InputError for parameters out of range and for more points than can be meshed
/// (tetgen.h), MissingProgram when TetGen is needed and not installed.
TetMesh shape_mesh(const Shape& shape, const InteriorPoints& interior);

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
