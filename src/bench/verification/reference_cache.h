#pragma once

#include <cstdint>
#include <filesystem>

#include "bench/verification/verification.h"

namespace mssim {

/// Keeps references of cloths and bodies for later runs, one file each. It only saves time: an entry that is
/// missing or damaged or cannot be written is not an error. Several processes may use it at once.
///
/// An entry's name and head consist of hashes of the program's file and of every number of the System,
/// integrator, time step and steps. It ends with a hash of the whole. So a program whose reference has been
/// corrected does not find entries of an earlier program.
struct ReferenceCache {
  std::filesystem::path folder;           ///< empty: no references are kept
  std::uint64_t program_fnv1a_64 = 0;     ///< hash of the running program's file
  double least_seconds = 1;               ///< references that take less time are not kept
  std::uint64_t most_bytes = 1ULL << 30;  ///< limit for all entries; the least recently used ones are removed
};

/// run_reference, or the result of an earlier run, with that run's `step_seconds`. `anew`: ignores and
/// replaces an entry. A reference of more than a quarter of most_bytes is not kept.
Reference recall_reference(const ReferenceCache& cache, const System& system, const Integrator& integrator,
                           double dt_s, bool anew = false);

}  // namespace mssim
