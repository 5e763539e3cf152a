#pragma once

#include <hdf5.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/surface.h"
#include "geometry/vec3.h"
#include "hdf5/hdf5.h"
#include "hdf5/hdf5_table.h"
#include "model/node_shape.h"
#include "output/traces/h5md_trace.h"
#include "text/error.h"

namespace mssim {

/// Content of a trace except its frames (h5md_trace.h).
struct TraceContent {
  NodeShape shape;
  std::vector<std::array<std::uint32_t, 2>> springs;  ///< may be empty; two nodes that differ
  std::vector<double> rest_length;  ///< [springs] m, above 0; empty in traces of earlier versions
  Surface body;                     ///< the fixed body; may be empty
  std::string scene_json;           ///< as written
  bool in_double = false;           ///< whether positions are in double precision
  std::size_t nodes = 0;            ///< at least one
  std::vector<std::int64_t> step;   ///< [frames] increasing; at least one frame
  std::vector<double> time_s;       ///< [frames] increasing
};

/// Reads and checks the content; indices are below the number of nodes, and the shape fits the nodes. Throws
/// Hdf5Error, Hdf5ContentError, and std::invalid_argument with the rule that a trace violates.
TraceContent read_trace_content(hid_t file);

/// The content of a trace of the system, without frames. `body` as in H5mdTrace.
TraceContent trace_content_of(const System& system, const TraceHeader& header, const Surface& body);

/// The group of the particles of a trace, for example /particles/cloth.
std::string particles_group(const TraceContent& content);

/// Whether the trace has the rest lengths of its springs; those of other programs may not.
inline bool has_strain(const TraceContent& content) {
  return content.rest_length.size() == content.springs.size();
}

/// [nodes] The mean strain of the springs at each node for these positions ([nodes] m); 0 for nodes without
/// springs, NaN for all without has_strain().
std::vector<double> node_strain(const TraceContent& content, const std::vector<Vec3d>& positions);

/// Thrown for a trace that cannot be read. what() is one sentence with the file, the error and the remedy.
/// Commands end with exit code 2, or with 4 if the system refused to read.
struct TraceError : Error {
  TraceError(const std::string& sentence, bool refused_by_system)
      : Error(refused_by_system ? exit_file_error : exit_bad_input, sentence) {}
};

/// Reads a trace of H5mdTrace, or the NAME.part of an unfinished run, which also has frames. The file is not
/// trusted: an inconsistency throws TraceError. Checksums are verified. Not thread-safe, even for different
/// traces, because the HDF5 library is not.
class TraceReader {
 public:
  /// Reads everything but the frames. Throws TraceError.
  explicit TraceReader(std::filesystem::path file);

  const std::filesystem::path& name() const { return name_; }
  const TraceContent& content() const { return content_; }
  std::size_t frames() const { return content_.step.size(); }

  /// [nodes] Positions of a frame, m. Throws TraceError, also for numbers that are not finite.
  std::vector<Vec3d> positions(std::size_t frame) const { return vectors(*position_, "position", frame); }
  /// [nodes] Velocities of a frame, m/s. Throws TraceError, also for numbers that are not finite.
  std::vector<Vec3d> velocities(std::size_t frame) const { return vectors(*velocity_, "velocity", frame); }

 private:
  void open();
  std::vector<Vec3d> vectors(const Hdf5Table& series, const std::string& what, std::size_t frame) const;

  std::filesystem::path name_;
  Hdf5File file_;
  TraceContent content_;
  std::optional<Hdf5Table> position_, velocity_;  // there after construction
};

}  // namespace mssim
