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
  std::string version;  ///< as TetGen reports it, for example "1.5", or "unknown"
  /// Hash of the program and its libraries: distinguishes two TetGens of the same version.
  std::uint64_t fnv1a_64 = 0;
};

/// The `tetgen` that PATH finds, or nothing.
std::optional<TetgenProgram> find_tetgen();

/// Reads a mesh from TetGen's .node and .ele files, numbered from 0 or 1; attributes and boundary markers are
/// ignored. The mesh is valid: finite coordinates, every node in a tetrahedron and at a location of its own,
/// positive volumes (if all are negative, the mesh is mirrored and its tetrahedra are turned), no face in
/// three tetrahedra. Throws InputError that names file, line and value.
TetMesh parse_tetgen_files(TextLines node_file, TextLines ele_file);

/// Reads the mesh from files. Throws like parse_tetgen_files, and if a file cannot be read.
TetMesh read_tetgen_files(const std::filesystem::path& node_file, const std::filesystem::path& ele_file);

/// The text of a .node file, numbered from 0; numbers keep their exact value.
std::string node_text(const std::vector<Vec3d>& nodes);

/// The text of an .ele file, numbered from 0.
std::string ele_text(const std::vector<Tetrahedron>& tetrahedra);

/// The text of a .smesh file, numbered from 0, without holes and regions: the surface that TetGen fills.
std::string smesh_text(const Surface& surface);

/// TetGen takes 40 us per point for thousands of points, and 90 us for hundreds of thousands.
inline constexpr std::uint64_t most_meshable_points = 4'000'000;

/// Throws InputError, which ends in the remedy, for more points than TetGen meshes within its limit of CPU
/// time.
void require_meshable(std::uint64_t points,
                      std::string_view remedy = "with fewer cells, triangles or points");

/// Throws InputError if TetGen needs more memory for this many points than is available.
void require_meshing_memory(std::uint64_t points);

/// Runs TetGen, as a process in a folder of its own, to fill a surface with tetrahedra. `switches` are
/// TetGen's, beginning "-p"; `interior` points become nodes (the switch i is added for them). Throws
/// InputError if TetGen cannot fill the surface: triangles cross each other (both are named), one closed part
/// lies inside another, it crashes or runs out of time or memory; MissingProgram if it cannot be started.
TetMesh run_tetgen(const TetgenProgram& program, const Surface& surface, const std::vector<Vec3d>& interior,
                   const std::string& switches);

}  // namespace mssim
