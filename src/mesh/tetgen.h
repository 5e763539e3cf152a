#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/surface.h"
#include "mesh/meshing.h"
#include "mesh/text_lines.h"

namespace mssim {

/// The installed TetGen.
struct TetgenProgram {
  std::filesystem::path executable;
  std::string version;  ///< as it calls itself, for example "1.5", or "unknown"
  /// Hash of the program and its library: it distinguishes two TetGens that give the same version.
  std::uint64_t fnv1a_64 = 0;
};

/// The `tetgen` that PATH finds, or nothing.
std::optional<TetgenProgram> find_tetgen();

/// Reads a mesh from TetGen's .node and .ele files, numbered from 0 or 1; attributes and boundary markers are
/// left out. The mesh is valid: finite coordinates, every node in a tetrahedron and at a place of its own,
/// positive volumes (when all are negative the mesh is mirrored and its tetrahedra are turned), no face in
/// three tetrahedra. Throws InputError that names file, line and value.
TetMesh parse_tetgen_files(TextLines node_file, TextLines ele_file);

/// Reads the mesh from files. Throws like parse_tetgen_files, and where a file cannot be read.
TetMesh read_tetgen_files(const std::filesystem::path& node_file, const std::filesystem::path& ele_file);

/// A .node file, numbered from 0; numbers read back as they are.
std::string node_text(const std::vector<Vec3d>& nodes);

/// An .ele file, numbered from 0.
std::string ele_text(const std::vector<Tetrahedron>& tetrahedra);

/// A .smesh file, numbered from 0, without holes and regions: what TetGen fills with tetrahedra.
std::string smesh_text(const Surface& surface);

/// A point takes TetGen 40 us where there are thousands, and 90 us where there are hundreds of thousands.
inline constexpr std::uint64_t most_meshable_points = 4'000'000;

/// Throws InputError, which ends in the remedy, for more points than TetGen meshes in the processor time that
/// it is given.
void require_meshable(std::uint64_t points,
                      std::string_view remedy = "with fewer cells, triangles or points");

/// Throws InputError where TetGen needs more memory than there is for a mesh of so many points.
void require_meshing_memory(std::uint64_t points);

/// Has TetGen fill a surface with tetrahedra. `switches` are TetGen's, beginning "-p"; `interior` points
/// become nodes (the switch i is added for them). Runs it as a process in a folder of its own. Throws
/// InputError when TetGen cannot fill the surface: triangles cross each other (both are named), one closed
/// part lies inside another, it crashes or runs out of time or memory; std::runtime_error when it cannot be
/// run.
TetMesh run_tetgen(const TetgenProgram& program, const Surface& surface, const std::vector<Vec3d>& interior,
                   const std::string& switches);

}  // namespace mssim
