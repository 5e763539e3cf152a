#pragma once

#include <hdf5.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/system.h"

namespace mssim {

/// XDMF describes a trace to viewers such as ParaView: a time series of a cloth as a structured surface, or
/// of bodies as tetrahedra, with the velocity of the nodes. Two things about ParaView 5.11 shape it. Its
/// Xdmf3 reader shows nothing, silently, when a frame is cut out of a dataset of all frames: so the trace
/// holds one virtual dataset per frame and vector. Its Xdmf2 reader finds the velocity of a structured mesh
/// only with three dimensions of nodes: so there is one layer of rows x columns.

/// What viewers are told about the nodes of a trace, the same in every frame.
struct XdmfMesh {
  std::string particles;       ///< "cloth" or "bodies", the group of nodes in /particles
  std::vector<hsize_t> shape;  ///< of the nodes: {1, rows, columns} or {nodes}
  hsize_t tetrahedra = 0;      ///< in `tetrahedra_dataset`; 0 for a structured surface
};
XdmfMesh xdmf_mesh_of(const System& system);

/// Path in the trace of the tetrahedra of bodies, [tetrahedra][4] uint32.
inline constexpr const char* tetrahedra_dataset = "/connectivity/tetrahedra";

/// Path in the trace of the virtual dataset of one frame, for example /xdmf/position/000012.
/// `vector` is "position" or "velocity"; the dataset has the mesh's shape and [3], float32.
std::string xdmf_dataset(std::string_view vector, std::size_t frame);

/// Adds the virtual datasets of frames 0 to frames - 1 to an open trace. Throws Hdf5Error.
void map_frames_for_xdmf(hid_t trace, const XdmfMesh& mesh, std::size_t frames);

/// Room in the file that the virtual datasets of one frame take at most (measured: 1000 bytes).
inline constexpr std::size_t xdmf_bytes_per_frame = 2048;

/// FILE.h5 -> FILE.xdmf, in the same folder.
std::filesystem::path xdmf_of(const std::filesystem::path& trace);

/// Writes the XDMF beside a finished trace. `times_s` has one entry per frame. Throws WriteError.
void write_xdmf(const std::filesystem::path& trace, const XdmfMesh& mesh, std::span<const double> times_s);

}  // namespace mssim
