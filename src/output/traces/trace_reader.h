#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec3.h"
#include "hdf5/hdf5.h"
#include "hdf5/hdf5_table.h"
#include "output/traces/trace_content.h"
#include "text/error.h"

namespace mssim {

/// Thrown for a trace that cannot be read. what() is one sentence that names the file, what is wrong with it
/// and what to do about it. Commands end with exit code 2, and with 4 where the system refused to read.
struct TraceError : Error {
  TraceError(const std::string& sentence, bool refused_by_system)
      : Error(refused_by_system ? exit_file_error : exit_bad_input, sentence) {}
};

/// Reads a trace that H5mdTrace wrote, or the NAME.part of a run that did not end, which has frames as well.
/// Nothing of the file is trusted: what does not fit gives a TraceError. Checksums are compared. Not for use
/// from several threads at a time, even on different traces: the HDF5 library is not.
class TraceReader {
 public:
  /// Reads everything but the frames. Throws TraceError.
  explicit TraceReader(std::filesystem::path file);

  const std::filesystem::path& name() const { return name_; }
  const TraceContent& content() const { return content_; }
  std::size_t frames() const { return content_.step.size(); }

  /// [nodes] m, of one of the frames. Throws TraceError, also for numbers that are not finite.
  std::vector<Vec3d> positions(std::size_t frame) const { return vectors(*position_, "position", frame); }
  /// [nodes] m/s. Throws TraceError, also for numbers that are not finite.
  std::vector<Vec3d> velocities(std::size_t frame) const { return vectors(*velocity_, "velocity", frame); }
  /// [frames] J: an energy or a loss by its name in /observables, for example "total_energy"; none where the
  /// trace has none of that name. Throws TraceError, also for numbers that are not finite.
  std::optional<std::vector<double>> observable(std::string_view name) const;

 private:
  void open();
  std::vector<Vec3d> vectors(const Hdf5Table& series, const std::string& what, std::size_t frame) const;

  std::filesystem::path name_;
  Hdf5File file_;
  TraceContent content_;
  std::optional<Hdf5Table> position_, velocity_;  // there after construction
};

}  // namespace mssim
