#pragma once

#include <hdf5.h>

#include <cstddef>
#include <string>

#include "model/system.h"

namespace mssim {

/// What a trace says about how it came about.
struct TraceHeader {
  std::string author = "unknown";  ///< who ran the simulation
  std::string creator_version;     ///< of mssim
  std::string scene_json;          ///< the scene file's text
  std::string provenance_json;     ///< the text of provenance.json
  std::string backend;
  std::string integrator;
  double dt_s = 0;
  bool with_losses = false;  ///< whether its frames say what has been taken from the energy
  /// Whether positions and velocities are stored in double precision, for backends that compute in it.
  bool in_double = false;
};

/// Throws std::invalid_argument unless there are nodes and the topology fits them: a file that points beyond
/// its nodes would crash who reads it.
void require_fitting_topology(const Topology& topology, std::size_t nodes);

/// Writes what a trace holds beside its frames: /h5md, /parameters, the group of particles (for example
/// /particles/cloth) with its box and masses, and /connectivity. Throws Hdf5Error.
void write_h5md_head(hid_t file, const std::string& particles, const System& system,
                     const TraceHeader& header);

}  // namespace mssim
