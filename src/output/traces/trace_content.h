#pragma once

#include <hdf5.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/surface.h"
#include "geometry/vec3.h"
#include "model/system.h"
#include "output/traces/h5md_trace.h"

namespace mssim {

/// What a trace says beside its frames (h5md_trace.h).
struct TraceContent {
  std::string particles;  ///< "cloth", "bodies" or "garment"
  /// A grid, whose spacing a trace does not say (0), tetrahedra, or a garment: its panels, seams, flat nodes
  /// and joints, without how it was dressed and what its joints weigh.
  Topology topology;
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

/// Reads and checks all of it; indices lie below the number of nodes, and the topology fits these. Throws
/// Hdf5Error, Hdf5ContentError, and std::invalid_argument with the rule that a trace breaks.
TraceContent read_trace_content(hid_t file);

/// What a trace of the system says, without frames. `body` as in H5mdTrace.
TraceContent trace_content_of(const System& system, const TraceHeader& header, const Surface& body);

/// Where the particles of a trace are, for example /particles/cloth.
std::string particles_group(const TraceContent& content);

/// [nodes] The mean strain of the springs at each node, at these positions ([nodes] m); 0 where there are
/// none. `content` has rest lengths.
std::vector<double> node_strain(const TraceContent& content, const std::vector<Vec3d>& positions);

}  // namespace mssim
