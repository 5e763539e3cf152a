#pragma once

#include <string_view>

namespace mssim {

// What the process that starts the launcher (launch.h) and the ranks say to each other: the ranks among all
// that they print.

/// The argument of mssim-mpi, and of its ranks, by which each steps the whole scene.
inline constexpr std::string_view copies_word = "copies";

/// On stdout, once: MPI has started, on all hosts.
inline constexpr std::string_view ranks_have_started = "mssim-mpi: all ranks have started";

/// On stderr, before the sentence with which a rank fails.
inline constexpr std::string_view sentence_mark = "mssim-mpi: ";

}  // namespace mssim
