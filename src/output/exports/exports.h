#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "geometry/vec3.h"
#include "hdf5/hdf5.h"
#include "model/system.h"
#include "output/traces/trace_reader.h"
#include "platform/files.h"

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

/// A VTKHDF 2.0 file (https://docs.vtk.org, "VTKHDF file format"): an UnstructuredGrid with times. The cells
/// are there once; each frame adds its points, their velocity and strain. `node` and `part` of the points are
/// the same in all frames; the names of parts stand in /parts, beside VTK's own group. One piece holds all.
class VtkhdfExport {
 public:
  /// Creates NAME.part. `mesh` has cells and must outlive this. Throws WriteError.
  VtkhdfExport(std::filesystem::path file, const ExportMesh& mesh);
  /// Appends a frame of the mesh. Throws WriteError; the file can then only be destroyed.
  void add(const ExportFrame& frame);
  /// Finishes the file, which has a frame at least, and gives it its name. Throws WriteError. Without it
  /// nothing is left.
  void close();

 private:
  void create();
  void write_steps() const;
  void append(const Hdf5Dataset& dataset, const std::string& name, const double* numbers) const;
  void guard(const std::function<void()>& write) const;

  AtomicFile output_;
  const ExportMesh& mesh_;
  Hdf5File file_;
  Hdf5Dataset points_, velocity_, strain_;
  std::vector<double> times_s_;  ///< [frames]
};

}  // namespace mssim
