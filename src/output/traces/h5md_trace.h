#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry/surface.h"
#include "hdf5/hdf5.h"
#include "model/energy.h"
#include "model/system.h"
#include "output/traces/xdmf.h"
#include "platform/files.h"

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

/// Throws std::invalid_argument where a body, which may be empty, has triangles beyond its points, points
/// without triangles, or stands beside something that is no garment.
void require_fitting_body(const Topology& topology, const Surface& body);

/// A trace: the frames of one simulation in an HDF5 file after H5MD 1.1 (https://www.nongnu.org/h5md), with
/// an XDMF file beside it for viewers. SI units throughout, listed in /parameters/units. PARTICLES is `cloth`
/// for a system on a grid, `bodies` for one of tetrahedra, and `garment` for one.
///
///     /h5md                                   author, creator, version of H5MD
///     /particles/PARTICLES/{position,velocity}/value  [frames][nodes][3] float32 or float64, in the scene's
///                                             node order
///     /particles/PARTICLES/mass               [nodes] float64
///     /observables/{kinetic,elastic,gravitational,total}_energy/value        [frames] float64
///     /observables/{damping,friction,bounce,integration}_loss/value   since the start, with_losses only
///     /observables                            attribute leaves_out, of a garment: energies_leave_out()
///     .../step, .../time                      [frames] int64, float64: the same two datasets everywhere
///     /connectivity/springs                   [springs][2] uint32, each unique spring once
///     /parameters/springs/{rest_length,stiffness,damping}     [springs] float64, in that order
///     /connectivity/tetrahedra                [tetrahedra][4] uint32, of bodies
///     /connectivity/joints                    [joints][3] uint32, of a garment: h5md_garment.h
///     /body/{points,triangles}                [points][3] float32, m, and [triangles][3] uint32,
///     counter-clockwise
///                                             seen from outside: the body that a garment is dressed on
///     /parameters                             scene and provenance as JSON, and how it was stepped
///     /parameters/{panels,joints,seams}       of a garment: h5md_garment.h
///     /xdmf/{position,velocity}/FRAME         virtual datasets, one frame each: [1][rows][columns][3] for
///                                             a cloth, [nodes][3] for bodies
///     /xdmf/{position,velocity}/PANEL/FRAME   of a garment, [1][rows][columns][3] for each panel, from 0 on
///     /xdmf/panel/{PANEL,body}                of a garment, the panel's number for each node, -1 for the
///     body
///
/// Positions and velocities are stored in single precision, as most backends compute them, which halves the
/// file, or in double, where the header says so; energies are double.
///
/// Until close() the file is called NAME.part. After write_frame() returns, the frame is with the system: a
/// program that is killed, or a disk that is full, leaves a NAME.part with all frames written so far, without
/// /xdmf. Not for use from several threads at a time, even on different traces: the HDF5 library is not.
class H5mdTrace {
 public:
  /// Creates NAME.part with everything but frames. The topology of `system` must fit its nodes, of which
  /// there is one at least, and `body`, which does not move and may be empty, stands beside garments alone
  /// (else std::invalid_argument). Throws WriteError.
  H5mdTrace(std::filesystem::path file, const System& system, const TraceHeader& header,
            const Surface& body = {});
  H5mdTrace(const H5mdTrace&) = delete;
  H5mdTrace& operator=(const H5mdTrace&) = delete;
  /// Without close(): gives up, keeping NAME.part when it holds frames.
  ~H5mdTrace();

  /// Appends a frame. `step` and `time_s` increase from frame to frame, `state` has the system's size, and
  /// `losses` are there if the header says so (else std::invalid_argument). Throws WriteError, which says
  /// what became of the frames before; the trace can then only be destroyed.
  void write_frame(std::int64_t step, double time_s, const State& state, const Energy& energy,
                   const std::optional<EnergyLosses>& losses = {});

  /// Finishes the trace, gives it its name and writes the XDMF. Throws WriteError.
  void close();
  /// Ends without giving the file its name; keeps NAME.part when it holds frames. Returns how many.
  std::size_t give_up();

  const std::filesystem::path& name() const { return output_.name(); }

 private:
  void create(const System& system, const TraceHeader& header, const Surface& body);
  void create_series(const System& system);
  std::string particles() const { return "/particles/" + mesh_.particles; }
  void append(std::int64_t step, double time_s, const State& state, const Energy& energy,
              const EnergyLosses& losses);
  void guard(const std::function<void()>& write);

  AtomicFile output_;
  XdmfMesh mesh_;
  bool with_losses_;
  Hdf5File file_;
  Hdf5Dataset step_, time_, position_, velocity_;  // of the particles
  std::vector<Hdf5Dataset> observables_;           // in the order of their table
  std::vector<double> times_s_;                    // [frames]
  std::int64_t last_step_ = 0;
};

}  // namespace mssim
