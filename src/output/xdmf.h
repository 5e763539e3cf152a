#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "model/grid_patch.h"

namespace mssim {

/// XDMF describes a trace to viewers such as ParaView: a time series of the cloth as a structured surface
/// with its velocity. ParaView 5.11's Xdmf3 reader shows nothing, silently, when a frame is cut out of a
/// dataset of all frames, so the trace holds one virtual dataset per frame and vector, and the XDMF names
/// those.

/// Path in the trace of the virtual dataset of one frame, for example /xdmf/position/000012.
/// `vector` is "position" or "velocity"; the dataset has the shape [rows][columns][3], float32.
std::string xdmf_dataset(std::string_view vector, std::size_t frame);

/// FILE.h5 -> FILE.xdmf, in the same folder.
std::filesystem::path xdmf_of(const std::filesystem::path& trace);

/// Writes the XDMF beside a finished trace. `times_s` has one entry per frame. Throws WriteError.
void write_xdmf(const std::filesystem::path& trace, const GridPatch& grid, std::span<const double> times_s);

}  // namespace mssim
