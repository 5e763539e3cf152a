#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/surface.h"
#include "model/system.h"

namespace mssim {

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
  std::string particles;  ///< "cloth", "bodies" or "garment", the group of nodes in /particles
  hsize_t nodes = 0;      ///< in that group
  std::vector<XdmfPart> parts;
  bool in_double = false;      ///< positions and velocities
  hsize_t tetrahedra = 0;      ///< in `tetrahedra_dataset`; 0 for structured surfaces
  hsize_t body_points = 0;     ///< of the body that does not move, in `body_points_dataset`
  hsize_t body_triangles = 0;  ///< in `body_triangles_dataset`; 0 where there is no such body

  /// Bytes of a number of positions and velocities.
  std::size_t bytes_per_number() const { return in_double ? sizeof(double) : sizeof(float); }
};
XdmfMesh xdmf_mesh_of(const System& system, const Surface& body, bool in_double = false);

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

}  // namespace mssim
