#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/vec3.h"
#include "model/tetrahedral_mesh.h"

namespace mssim {

/// A solid body cut into tetrahedra.
struct TetMesh {
  std::vector<Vec3d> nodes;  ///< m
  std::vector<Tetrahedron> tetrahedra;
  std::string note = {};  ///< what a reader should know of how it was made, in a sentence; or empty
};

/// The unique edges of the tetrahedra, the lower node first, ascending.
std::vector<std::array<std::uint32_t, 2>> edges_of(const TetMesh& mesh);

/// The faces of the tetrahedra, ascending, the nodes of each ascending, each as often as tetrahedra have it:
/// one inside the body stands twice, one on its surface once.
std::vector<std::array<std::uint32_t, 3>> faces_of(const TetMesh& mesh);

/// The sum of the tetrahedra's volumes, m^3.
double volume_of(const TetMesh& mesh);

/// The smallest angle between two faces of a tetrahedron, degrees; 180 for a mesh without tetrahedra.
double smallest_dihedral_angle(const TetMesh& mesh);

/// Nodes - edges + faces - tetrahedra: 1 for a solid ball, 0 for a solid torus.
std::int64_t euler_characteristic(const TetMesh& mesh);

}  // namespace mssim
