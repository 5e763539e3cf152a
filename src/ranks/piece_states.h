#pragma once

#include <filesystem>

#include "ranks/cloth_piece.h"
#include "ranks/session.h"

namespace mssim {

/// States between mssim and the pieces: rank 0 has the file of a state (docs/own-backends.md), and each rank
/// its columns. No rank holds more than a piece and some rows. All ranks call these together.

/// Gives every rank its columns, ghosts included, of the state in the file, which only rank 0 looks at.
/// Throws RankFailure.
void scatter_state(const Session& session, const std::filesystem::path& file, ClothPiece& piece);

/// Writes the state of all ranks into the file.
void gather_state(const Session& session, const std::filesystem::path& file, const ClothPiece& piece);

}  // namespace mssim
