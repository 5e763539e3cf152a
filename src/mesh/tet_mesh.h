#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vec3.h"
#include "model/system.h"

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

/// What makes a mesh useless, and the node or tetrahedron at which it shows.
struct MeshDefect {
  enum Of { node, tetrahedron } of = node;
  std::size_t index = 0;
  std::string what;  ///< half a sentence: what is wrong, and what to do about it
};

/// The first defect of a mesh whose indices are in range and whose coordinates are finite: a node of no
/// tetrahedron, two nodes at one place, a tetrahedron that is flat or turned inside out, a face that three
/// tetrahedra share.
std::optional<MeshDefect> find_defect(const TetMesh& mesh);

/// When every tetrahedron's volume is negative, the file counts its nodes the other way round: swaps two
/// nodes of each.
void turn_if_mirrored(TetMesh& mesh);

}  // namespace mssim
