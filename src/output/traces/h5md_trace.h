#pragma once

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
#include "output/traces/h5md_head.h"
#include "output/traces/xdmf.h"
#include "platform/files.h"

namespace mssim {

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
///     /body/{points,triangles}                of a body that does not move: h5md_body.h
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
