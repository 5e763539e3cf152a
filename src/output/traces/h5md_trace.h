#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/surface.h"
#include "hdf5/hdf5.h"
#include "model/node_shape.h"
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

/// Throws std::invalid_argument where a body, which may be empty, has triangles beyond its points, points
/// without triangles, or stands beside something that is no garment.
void require_fitting_body(const NodeShape& shape, const Surface& body);

/// XDMF describes a trace to viewers such as ParaView: a time series of a cloth as a structured surface, of
/// bodies as tetrahedra, or of a garment as a structured surface for each panel, with the velocity of the
/// nodes; and a body that does not move, which all frames share. To be coloured apart in any viewer the nodes
/// of a panel have its number as `panel`, those of the body -1. Two things about ParaView 5.11 shape it. Its
/// Xdmf3 reader shows nothing, silently, when a frame is cut out of a dataset of all frames: so the trace
/// holds one virtual dataset per frame, part and vector. Its Xdmf2 reader finds the velocity of a structured
/// mesh only with three dimensions of nodes: so there is one layer of rows x columns.

/// Nodes that follow each other in a trace and are shown as one thing.
struct XdmfPart {
  std::string name;                   ///< for viewers, who may take any text
  std::optional<std::int32_t> panel;  ///< its number, where it is the panel of a garment
  hsize_t first_node = 0;
  std::vector<hsize_t> shape;  ///< of the nodes: {1, rows, columns} or {nodes}
};

/// What viewers are told about a trace, the same in every frame.
struct XdmfMesh {
  std::string_view particles;  ///< NodeShape::kind, the group of nodes in /particles
  hsize_t nodes = 0;           ///< in that group
  std::vector<XdmfPart> parts;
  bool in_double = false;      ///< positions and velocities
  hsize_t tetrahedra = 0;      ///< in `tetrahedra_dataset`; 0 for structured surfaces
  hsize_t body_points = 0;     ///< of the body that does not move, in `body_points_dataset`
  hsize_t body_triangles = 0;  ///< in `body_triangles_dataset`; 0 where there is no such body

  /// Bytes of a number of positions and velocities.
  std::size_t bytes_per_number() const { return in_double ? sizeof(double) : sizeof(float); }
};
XdmfMesh xdmf_mesh_of(const NodeShape& shape, std::size_t nodes, const Surface& body, bool in_double = false);

/// Path in the trace of the tetrahedra of bodies, [tetrahedra][4] uint32.
inline constexpr const char* tetrahedra_dataset = "/connectivity/tetrahedra";

/// Paths in the trace of the body that does not move: [points][3] float32, [triangles][3] uint32.
inline constexpr const char* body_points_dataset = "/body/points";
inline constexpr const char* body_triangles_dataset = "/body/triangles";

/// Path in the trace of the virtual dataset of one part in one frame, for example /xdmf/position/000012 or
/// /xdmf/position/2/000012. `vector` is "position" or "velocity"; the dataset has the part's shape and [3].
std::string xdmf_dataset(std::string_view vector, const XdmfPart& part, std::size_t frame);

/// Path in the trace of the panel's number at each node of a part, [1][rows][columns] int32, and at each
/// point of the body. These take no room: they are nothing but their fill value.
std::string xdmf_panel_dataset(const XdmfPart& part);
inline constexpr const char* xdmf_panel_dataset_of_body = "/xdmf/panel/body";

/// Adds the virtual datasets of frames 0 to frames - 1, and the numbers of panels, to an open trace. Throws
/// Hdf5Error.
void map_frames_for_xdmf(hid_t trace, const XdmfMesh& mesh, std::size_t frames);

/// Room in the file that the virtual datasets of one part in one frame take at most (measured: 1000 bytes).
inline constexpr std::size_t xdmf_bytes_per_part_and_frame = 2048;

/// FILE.h5 -> FILE.xdmf, in the same folder.
std::filesystem::path xdmf_of(const std::filesystem::path& trace);

/// Writes the XDMF beside a finished trace. `times_s` has one entry per frame. Throws WriteError.
void write_xdmf(const std::filesystem::path& trace, const XdmfMesh& mesh, std::span<const double> times_s);

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
  void create(const System& system, const NodeShape& shape, const TraceHeader& header, const Surface& body);
  void create_series(const System& system);
  std::string particles() const { return "/particles/" + std::string(mesh_.particles); }
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
