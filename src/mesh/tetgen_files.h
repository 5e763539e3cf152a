#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "geometry/surface.h"
#include "mesh/tet_mesh.h"

namespace mssim {

/// The text of a file and the name that messages give it.
struct NamedText {
  std::string name;
  std::string_view text;
};

/// Reads a mesh from TetGen's .node and .ele files, numbered from 0 or 1; attributes and boundary markers are
/// left out. The mesh is valid: finite coordinates, every node in a tetrahedron and at a place of its own,
/// positive volumes (when all are negative the mesh is mirrored and its tetrahedra are turned), no face in
/// three tetrahedra. Throws InputError that names file, line and value.
TetMesh parse_tetgen_files(const NamedText& node_file, const NamedText& ele_file);

/// The same from files.
TetMesh read_tetgen_files(const std::filesystem::path& node_file, const std::filesystem::path& ele_file);

/// A .node file, numbered from 0; numbers read back as they are.
std::string node_text(const std::vector<Vec3d>& nodes);

/// An .ele file, numbered from 0.
std::string ele_text(const std::vector<Tetrahedron>& tetrahedra);

/// A .smesh file, numbered from 0, without holes and regions: what TetGen fills with tetrahedra.
std::string smesh_text(const Surface& surface);

}  // namespace mssim
