#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "mesh/tet_mesh.h"

namespace mssim {

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
