#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/vec3.h"
#include "model/system.h"
#include "output/traces/trace_reader.h"

namespace mssim {

/// What other programs get to see of a trace, the same points and cells in every frame.
struct ExportMesh {
  std::vector<std::int32_t> node;  ///< [points] the node that each is; -1 on the body that does not move
  std::vector<std::int32_t> part;  ///< [points] index into `parts`; -1 on the body that does not move
  std::vector<std::string> parts;  ///< "cloth", "body 1", or the names of panels
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of points
  std::vector<Tetrahedron> tetrahedra;                  ///< of points
  std::vector<Vec3d> fixed;  ///< m, the last points: those of the body that does not move
  bool in_double = false;    ///< how the trace holds positions, and files are to
};

/// The triangles of cloths, of garments with the body, and of the outside of bodies; inner nodes are left
/// out.
ExportMesh surface_mesh(const TraceContent& content);

/// The mesh with bodies as their tetrahedra between all nodes.
ExportMesh solid_mesh(const TraceContent& content);

/// One frame of a mesh.
struct ExportFrame {
  double time_s = 0;
  std::vector<Vec3d> position;  ///< [points] m
  std::vector<Vec3d> velocity;  ///< [points] m/s
  std::vector<double> strain;   ///< [points] node_strain(), 0 on the body that does not move
};

/// Reads a frame. Throws TraceError.
ExportFrame frame_of(const TraceReader& trace, const ExportMesh& mesh, std::size_t frame);

/// The text of a Wavefront OBJ: points, and triangles as an object a part. Numbers read back as the same.
std::string obj_of(const ExportMesh& mesh, const ExportFrame& frame);

/// The bytes of a PLY, binary and little-endian: of each point x, y, z, the velocity vx, vy, vz, the strain
/// of its springs, its node in the trace and its part, whose names are comments; and the triangles.
std::string ply_of(const ExportMesh& mesh, const ExportFrame& frame);

}  // namespace mssim
