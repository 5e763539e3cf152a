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

/// Origin of a trace.
struct TraceHeader {
  std::string author = "unknown";  ///< who ran the simulation
  std::string creator_version;     ///< of mssim
  std::string scene_json;          ///< the scene file's text
  std::string provenance_json;     ///< the text of provenance.json
  std::string backend;
  std::string integrator;
  double dt_s = 0;
  bool with_losses = false;  ///< whether frames have energy losses
  /// Whether positions and velocities are stored in double precision, for backends that compute in it.
  bool in_double = false;
};

/// Throws std::invalid_argument if the body (which may be empty) has triangles with missing points, has
/// points without triangles, or belongs to something other than a garment.
void require_fitting_body(const NodeShape& shape, const Surface& body);

/// XDMF describes a trace for viewers such as ParaView: a time series of a cloth as a structured surface, of
/// bodies as tetrahedra, or of a garment as one structured surface per panel, with the velocity of the nodes,
/// and a fixed body that all frames share. So that viewers can colour panels, their nodes have the panel's
/// number as `panel`; the body's have -1. Two properties of ParaView 5.11 determine the layout. Its Xdmf3
/// reader silently shows nothing if a frame is cut out of a dataset of all frames, so the trace has one
/// virtual dataset per frame, part and vector. Its Xdmf2 reader finds the velocity of a structured mesh only
/// with three dimensions of nodes, so there is one layer of rows x columns.

/// Consecutive nodes of a trace that are shown as one object.
struct XdmfPart {
  std::string name;                   ///< for viewers; any text
  std::optional<std::int32_t> panel;  ///< panel number, for panels of a garment
  hsize_t first_node = 0;
  std::vector<hsize_t> shape;  ///< of the nodes: {1, rows, columns} or {nodes}
};

/// The mesh of a trace for viewers, the same in every frame.
struct XdmfMesh {
  std::string_view particles;  ///< NodeShape::kind, the group of nodes in /particles
  hsize_t nodes = 0;           ///< in that group
  std::vector<XdmfPart> parts;
  bool in_double = false;      ///< positions and velocities
  hsize_t tetrahedra = 0;      ///< in `tetrahedra_dataset`; 0 for structured surfaces
  hsize_t body_points = 0;     ///< of the body that does not move, in `body_points_dataset`
  hsize_t body_triangles = 0;  ///< in `body_triangles_dataset`; 0 without such a body

  /// Bytes of a number in positions and velocities.
  std::size_t bytes_per_number() const { return in_double ? sizeof(double) : sizeof(float); }
};
/// The XDMF mesh of a trace with this shape, number of nodes and body.
XdmfMesh xdmf_mesh_of(const NodeShape& shape, std::size_t nodes, const Surface& body, bool in_double = false);

/// Path in the trace of the tetrahedra of bodies, [tetrahedra][4] uint32.
inline constexpr const char* tetrahedra_dataset = "/connectivity/tetrahedra";

/// Paths in the trace of the body that does not move: [points][3] float32, [triangles][3] uint32.
inline constexpr const char* body_points_dataset = "/body/points";
inline constexpr const char* body_triangles_dataset = "/body/triangles";

/// Path in the trace of the virtual dataset of one part in one frame, for example /xdmf/position/000012 or
/// /xdmf/position/2/000012. `vector` is "position" or "velocity"; the dataset has the part's shape and [3].
std::string xdmf_dataset(std::string_view vector, const XdmfPart& part, std::size_t frame);

/// Adds the virtual datasets of frames 0 to frames - 1, and the panel numbers, to an open trace. Throws
/// Hdf5Error.
void map_frames_for_xdmf(hid_t trace, const XdmfMesh& mesh, std::size_t frames);

/// Upper bound of the space that the virtual dataset of one part in one frame takes (measured: 1000 bytes).
inline constexpr std::size_t xdmf_bytes_per_part_and_frame = 2048;

/// The error in a trace's file name, with the remedy; none if it is valid. It must be NAME.h5 with
/// characters that an XDMF file can name. XDMF readers take the text after ':' as a dataset's path, '|' as
/// the end of a name, and '\' as a '/' or an escape. Control characters and text that is not UTF-8 are not
/// valid XML. The folder does not matter.
std::optional<std::string> trace_name_problem(const std::filesystem::path& trace);

/// FILE.h5 -> FILE.xdmf, in the same folder.
std::filesystem::path xdmf_of(const std::filesystem::path& trace);

/// Writes the XDMF next to a finished trace. `times_s` has one entry per frame. Throws WriteError.
void write_xdmf(const std::filesystem::path& trace, const XdmfMesh& mesh, std::span<const double> times_s);

/// The frames of one simulation in an HDF5 file in the format H5MD 1.1 (https://www.nongnu.org/h5md), with an
/// XDMF file for viewers. Units are SI, listed in /parameters/units. PARTICLES is `cloth` for a system on a
/// grid, `bodies` for one of tetrahedra, and `garment` for a garment.
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
///     /parameters/springs/rest_length, and each of spring_constants   [springs] float64, in that order
///     /connectivity/tetrahedra                [tetrahedra][4] uint32, of bodies
///     /connectivity/joints                    [joints][3] uint32, of a garment: h5md_garment.h
///     /body/{points,triangles}                [points][3] float32, m, and [triangles][3] uint32, seen
///                                             counter-clockwise from outside: the garment's body
///     /parameters                             scene and provenance as JSON, and how it was stepped
///     /parameters/{panels,joints,seams}       of a garment: h5md_garment.h
///     /xdmf/{position,velocity}/FRAME         virtual datasets, one frame each: [1][rows][columns][3] for
///                                             a cloth, [nodes][3] for bodies
///     /xdmf/{position,velocity}/PANEL/FRAME   of a garment, [1][rows][columns][3] for each panel, from 0 on
///     /xdmf/panel/{PANEL,body}                of a garment, the panel's number per node, -1 for the body
///
/// Positions and velocities are stored in single precision, in which most backends compute them and which
/// halves the file, or in double precision if the header says so. Energies are in double precision.
///
/// Until close() the file is called NAME.part. After write_frame() returns, the operating system has the
/// frame: if the program is killed or the disk is full, NAME.part has all frames written so far, without
/// /xdmf. Not thread-safe, even for different traces, because the HDF5 library is not.
class H5mdTrace {
 public:
  /// Creates NAME.part with everything but frames. Throws WriteError. The topology of `system` must fit its
  /// nodes, of which there must be at least one. `body`, which does not move and may be empty, is only
  /// allowed for garments (otherwise std::invalid_argument).
  H5mdTrace(std::filesystem::path file, const System& system, const TraceHeader& header,
            const Surface& body = {});
  /// Without close(): gives up, keeping NAME.part when it holds frames.
  ~H5mdTrace();

  /// Appends a frame. `step` and `time_s` must increase from frame to frame, `state` must have the system's
  /// size, and `losses` must be given if and only if the header says so (otherwise std::invalid_argument).
  /// Throws WriteError, which says what became of the earlier frames; the trace can then only be destroyed.
  void write_frame(std::int64_t step, double time_s, const State& state, const Energy& energy,
                   const std::optional<EnergyLosses>& losses = {});

  /// Finishes the trace, gives it its name and writes the XDMF. Throws WriteError.
  void close();
  /// Ends without giving the file its name; keeps NAME.part if it has frames. Returns their number.
  std::size_t give_up();

  const std::filesystem::path& name() const { return output_.name(); }

 private:
  void create(const System& system, const NodeShape& shape, const TraceHeader& header, const Surface& body);
  void create_all_series(const System& system);
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
