#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/surface.h"
#include "mesh/tet_mesh.h"
#include "mesh/tetgen_program.h"

namespace mssim {

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
