#pragma once

#include <hdf5.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "model/grid_patch.h"

namespace mssim {

/// XDMF describes a trace to viewers such as ParaView: a time series of the cloth as a structured surface
/// with its velocity. Two things about ParaView 5.11 shape it. Its Xdmf3 reader shows nothing, silently, when
/// a frame is cut out of a dataset of all frames: so the trace holds one virtual dataset per frame and
/// vector. Its Xdmf2 reader finds the velocity of a structured mesh only with three dimensions of nodes: so
/// there is one layer of rows x columns.

/// Path in the trace of the virtual dataset of one frame, for example /xdmf/position/000012.
/// `vector` is "position" or "velocity"; the dataset has the shape [1][rows][columns][3], float32.
std::string xdmf_dataset(std::string_view vector, std::size_t frame);

/// Adds the virtual datasets of frames 0 to frames - 1 to an open trace. Throws Hdf5Error.
void map_frames_for_xdmf(hid_t trace, const GridPatch& grid, std::size_t frames);

/// Room in the file that the virtual datasets of one frame take at most (measured: 1000 bytes).
inline constexpr std::size_t xdmf_bytes_per_frame = 2048;

/// FILE.h5 -> FILE.xdmf, in the same folder.
std::filesystem::path xdmf_of(const std::filesystem::path& trace);

/// Writes the XDMF beside a finished trace. `times_s` has one entry per frame. Throws WriteError.
void write_xdmf(const std::filesystem::path& trace, const GridPatch& grid, std::span<const double> times_s);

}  // namespace mssim
