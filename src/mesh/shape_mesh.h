#pragma once

#include <cstdint>
#include <variant>

#include "mesh/box_shape.h"
#include "mesh/interior_points.h"
#include "mesh/sphere_shape.h"
#include "mesh/tet_mesh.h"
#include "mesh/torus_shape.h"

namespace mssim {

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
/// (tetrahedralise.h). Throws InputError for parameters out of range and for
/// more points than can be meshed (tetgen.h), MissingProgram when TetGen is needed and
/// not installed.
TetMesh shape_mesh(const Shape& shape, const InteriorPoints& interior);

}  // namespace mssim
