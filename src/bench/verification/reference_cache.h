#pragma once

#include <cstdint>
#include <filesystem>

#include "bench/verification/verification.h"

namespace mssim {

/// Where references of cloths and bodies are kept for later runs, one file each. It only saves time: an entry
/// that is missing, damaged or cannot be written is no error, and several processes may use it at once.
///
/// An entry is named and headed by hashes of the program's file and of every number of the System, and by
/// integrator, time step and steps; a hash of the whole ends it. A program whose reference has been corrected
/// finds nothing of what an earlier one left.
struct ReferenceCache {
  std::filesystem::path folder;           ///< empty: nothing is kept
  std::uint64_t program_fnv1a_64 = 0;     ///< hash of the running program's file
  double least_seconds = 1;               ///< references that take less are not kept
  std::uint64_t most_bytes = 1ULL << 30;  ///< of all entries, of which the least recently used go
};

/// run_reference, or what it has found in an earlier run; `step_seconds` are then those of that run. `anew`:
/// whatever is there is replaced. One that takes more than a quarter of most_bytes is not kept.
Reference recall_reference(const ReferenceCache& cache, const System& system, const Integrator& integrator,
                           double dt_s, bool anew = false);

}  // namespace mssim
