#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/surface.h"
#include "geometry/vec3.h"
#include "model/system.h"

namespace mssim {

/// A solid body cut into tetrahedra.
struct TetMesh {
  std::vector<Vec3d> nodes;  ///< m
  std::vector<Tetrahedron> tetrahedra;
  std::string note = {};  ///< how it was made, if a reader should know; a sentence or empty
};

/// The unique edges of the tetrahedra, the lower node first, ascending.
std::vector<std::array<std::uint32_t, 2>> edges_of(const TetMesh& mesh);

/// The faces of the tetrahedra in ascending order, the nodes of each ascending. A face inside the body
/// appears twice, one on its surface once.
std::vector<std::array<std::uint32_t, 3>> faces_of(const TetMesh& mesh);

/// The sum of the tetrahedra's volumes, m^3.
double volume_of(const TetMesh& mesh);

/// The smallest angle between two faces of a tetrahedron, degrees; 180 for a mesh without tetrahedra.
double smallest_dihedral_angle(const TetMesh& mesh);

/// A defect that makes a mesh useless, and the node or tetrahedron where it was found.
struct MeshDefect {
  enum Of { node, tetrahedron } of = node;
  std::size_t index = 0;
  std::string what;  ///< half a sentence: the defect and its remedy
};

/// The first defect of a mesh whose indices are in range and whose coordinates are finite: a node of no
/// tetrahedron, two nodes at one place, a flat or inverted tetrahedron, or a face that three tetrahedra
/// share.
std::optional<MeshDefect> find_defect(const TetMesh& mesh);

/// If every tetrahedron's volume is negative (the file counts nodes in the opposite sense), swaps two nodes
/// of each.
void turn_if_mirrored(TetMesh& mesh);

/// A box around the origin, its sides along the axes.
struct BoxShape {
  Vec3d size;  ///< m, length of the sides
  std::array<std::uint32_t, 3>
      cells;  ///< squares of the surface along x, y and z, each cut into two triangles

  bool operator==(const BoxShape&) const = default;
};

/// The surface, of at least one cell each way; 2 (ab + bc + ca) + 2 points for a x b x c cells. Throws
/// InputError for a size of less than 0.0001 m or more than 1000 m.
Surface surface_of(const BoxShape& box);

/// A sphere around the origin: an icosahedron whose triangles are cut into frequency^2 each and projected
/// onto the sphere.
struct SphereShape {
  double radius_m = 0;          ///< m
  std::uint32_t frequency = 0;  ///< triangles along an edge of the icosahedron

  bool operator==(const SphereShape&) const = default;
};

/// The surface, of a positive frequency; 10 frequency^2 + 2 points. Throws InputError for a radius of less
/// than 0.0001 m or more than 1000 m.
Surface surface_of(const SphereShape& sphere);

/// A ring around the y axis: a circle of the minor radius whose centre moves around the origin at the major
/// radius.
struct TorusShape {
  double major_radius_m = 0;  ///< m
  double minor_radius_m = 0;  ///< m, less than major_radius_m
  std::uint32_t cells_around =
      0;  ///< circles along the ring, an even number: every other one is turned by half a cell
  std::uint32_t cells_across = 0;  ///< points of each circle

  bool operator==(const TorusShape&) const = default;
};

/// The surface, of at least 4 cells around and 3 across; cells_around x cells_across points. Throws
/// InputError for radii that make no ring, and an odd number of cells around.
Surface surface_of(const TorusShape& torus);

/// The nodes inside a generated body: points of a body-centred cubic lattice, slightly perturbed at random.
/// (That lattice gives the best-shaped tetrahedra that fill space.)
struct InteriorPoints {
  std::uint32_t count = 0;
  std::uint32_t seed = 0;  ///< of the lattice's position and rotation and of the perturbations
  double jitter = 0;       ///< maximum perturbation along each axis, in lattice spacings, 0 to 0.5
  double margin = 0;       ///< smallest distance from the surface, in lattice spacings, 0 to 1

  bool operator==(const InteriorPoints&) const = default;
};

/// TetGen's switches that fill a surface and keep it as it is.
inline constexpr const char* keep_surface = "-pY";

/// The mesh that TetGen makes of a valid surface (validate_surface) and points inside it, or its copy in the
/// cache. Its nodes are the surface's points, then the interior points, then TetGen's own. Without TetGen, a
/// cached mesh of another TetGen is used. `added_points`: lower bound on the points that TetGen adds. Throws
/// what run_tetgen and require_meshing_memory throw, and MissingProgram if TetGen is needed and not
/// installed.
TetMesh tetrahedralise(const Surface& surface, const std::vector<Vec3d>& interior,
                       const std::string& switches, std::uint64_t added_points = 0);

/// The size of the mesh when its scene was written. Another TetGen may give another size, which is reported,
/// not refused.
struct MeshSize {
  std::uint32_t nodes = 0;
  std::uint32_t springs = 0;  ///< unique edges

  bool operator==(const MeshSize&) const = default;
};

/// The shapes that mssim can make by itself.
using Shape = std::variant<BoxShape, SphereShape, TorusShape>;

/// A body of such a shape.
struct GeneratedShape {
  Shape solid;
  InteriorPoints interior;

  bool operator==(const GeneratedShape&) const = default;
};

/// Number of points that TetGen gets for a shape, without making them.
std::uint64_t point_count(const GeneratedShape& shape);

/// TetGen's input for a shape: its surface and the points inside.
struct ShapePoints {
  Surface surface;
  std::vector<Vec3d> interior;
};
/// Makes these points; those inside lie within the triangles of the surface. Throws InputError like
/// surface_of, and for points less than 10 micrometres apart.
ShapePoints points_of(const GeneratedShape& shape);

/// The mesh of a shape: its surface points first, then the interior points, then those that TetGen had to add
/// (none for the bodies of the committed scenes). Made by TetGen or taken from the cache (tetrahedralise).
/// Throws InputError like points_of, for more points than can be meshed (tetgen.h) and if TetGen leaves a
/// point out; MissingProgram if TetGen is needed and not installed.
TetMesh shape_mesh(const GeneratedShape& shape);

/// A body whose closed surface comes from a user's file, to be filled with tetrahedra.
struct SurfaceFile {
  std::string file;                   ///< .obj or .stl
  double unit_m = 1;                  ///< metres in one unit of the file; 0.001 for a drawing in millimetres
  double largest_tetrahedron_m3 = 0;  ///< maximum volume; 0: no limit

  bool operator==(const SurfaceFile&) const = default;
};

/// The mesh of such a body: TetGen adds nodes, inside and on the surface, until the tetrahedra are well
/// shaped and small enough; the shape stays. Uses the cache. Throws InputError, which names the file, if it
/// cannot be read, encloses no body or is too thin to be filled, and for a volume limit that makes more than
/// ten million tetrahedra; MissingProgram if TetGen is needed and not installed.
TetMesh surface_mesh(const SurfaceFile& body);

}  // namespace mssim
