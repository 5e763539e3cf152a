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

/// The mesh of a trace for other programs, with the same points and cells in every frame.
struct ExportMesh {
  std::vector<std::int32_t> node;  ///< [points] node number; -1 on the body that does not move
  std::vector<std::int32_t> part;  ///< [points] index into `parts`; -1 on the body that does not move
  std::vector<std::string> parts;  ///< "cloth", "body 1", or the names of panels
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of points
  std::vector<Tetrahedron> tetrahedra;                  ///< of points
  std::vector<Vec3d> fixed;                             ///< m, the last points: the body that does not move
  bool in_double = false;                               ///< precision of positions in the trace and in files
};

/// The triangles of cloths, of garments and their body, and of the surface of bodies; inner nodes are left
/// out.
ExportMesh surface_mesh(const TraceContent& content);

/// The mesh with bodies as tetrahedra between all nodes.
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

/// The text of a Wavefront OBJ: points, and triangles with one object per part. Numbers read back unchanged.
std::string obj_of(const ExportMesh& mesh, const ExportFrame& frame);

/// The bytes of a binary, little-endian PLY. Each point has x, y, z, the velocity vx, vy, vz, the strain of
/// its springs, its node in the trace and its part; the names of parts are comments. Triangles follow.
std::string ply_of(const ExportMesh& mesh, const ExportFrame& frame);

/// A VTKHDF 2.0 file (https://docs.vtk.org, "VTKHDF file format"): an UnstructuredGrid with times. Cells are
/// stored once; each frame adds its points, their velocity and strain. `node` and `part` of the points are
/// the same in all frames. The names of parts are in /parts, next to VTK's own group. There is one piece.
class VtkhdfExport {
 public:
  /// Creates NAME.part. `mesh` has cells and must outlive this. Throws WriteError.
  VtkhdfExport(std::filesystem::path file, const ExportMesh& mesh);
  /// Appends a frame of the mesh. Throws WriteError; the object can then only be destroyed.
  void add(const ExportFrame& frame);
  /// Finishes the file, which must have a frame, and gives it its name. Throws WriteError. Without close() no
  /// file remains.
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
