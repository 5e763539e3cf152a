#pragma once

#include <hdf5.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/surface.h"
#include "geometry/vec3.h"
#include "hdf5/hdf5.h"
#include "hdf5/hdf5_table.h"
#include "model/node_shape.h"
#include "output/traces/h5md_trace.h"
#include "text/error.h"

namespace mssim {

/// What a trace says beside its frames (h5md_trace.h).
struct TraceContent {
  NodeShape shape;
  std::vector<std::array<std::uint32_t, 2>> springs;  ///< may be empty; two nodes that differ
  std::vector<double> rest_length;              ///< [springs] m, above 0; empty in traces of earlier versions
  Surface body;                                 ///< that does not move; may be empty
  std::string scene_json, backend, integrator;  ///< as written
  double dt_s = 0;
  bool in_double = false;          ///< the positions, and not in single precision
  std::size_t nodes = 0;           ///< one at least
  std::vector<std::int64_t> step;  ///< [frames] increasing; one frame at least
  std::vector<double> time_s;      ///< [frames] increasing
};

/// Reads and checks all of it; indices lie below the number of nodes, and the shape fits these. Throws
/// Hdf5Error, Hdf5ContentError, and std::invalid_argument with the rule that a trace breaks.
TraceContent read_trace_content(hid_t file);

/// What a trace of the system says, without frames. `body` as in H5mdTrace.
TraceContent trace_content_of(const System& system, const TraceHeader& header, const Surface& body);

/// Where the particles of a trace are, for example /particles/cloth.
std::string particles_group(const TraceContent& content);

/// [nodes] The mean strain of the springs at each node, at these positions ([nodes] m); 0 where there are
/// none. `content` has rest lengths.
std::vector<double> node_strain(const TraceContent& content, const std::vector<Vec3d>& positions);

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
