#pragma once

#include <filesystem>

#include "ranks/piece.h"
#include "ranks/session.h"

namespace mssim {

/// States between mssim and the pieces: rank 0 has the file of a state (docs/own-backends.md), and each rank
/// its part. No rank holds more than its part and a message. All ranks call these together; they throw
/// RankFailure.

/// Gives every rank what it takes of the state in the file.
void scatter_state(const Session& session, const std::filesystem::path& file, Piece& piece);

/// Writes what every rank owns into the file.
void gather_state(const Session& session, const std::filesystem::path& file, const Piece& piece);

/// The same of a window of a cloth: the file has its nodes alone.
void gather_window(const Session& session, const std::filesystem::path& file, const Piece& piece,
                   const GridWindow& window);

}  // namespace mssim
