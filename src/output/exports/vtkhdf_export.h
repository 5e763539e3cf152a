#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "hdf5/hdf5.h"
#include "output/exports/exports.h"
#include "platform/files.h"

namespace mssim {

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
