#pragma once

#include <string_view>

namespace mssim {

// What the ranks say to the process that has started their launcher (launch.h), among all that they print.

/// On stdout, once: MPI has started, on all hosts.
inline constexpr std::string_view ranks_have_started = "mssim-mpi: all ranks have started";

/// On stderr, before the sentence with which a rank fails.
inline constexpr std::string_view sentence_mark = "mssim-mpi: ";

}  // namespace mssim
