#pragma once

#include <cstdint>
#include <filesystem>

namespace mssim {

/// Asks the file system for room for `bytes` more behind the end of an open file, whose size stays as it is,
/// so that a writer whose files do not survive a failed write can learn before it writes. Returns 0, or the
/// errno of the reason why there is no room. File systems that cannot reserve answer 0.
int reserve_space(int descriptor, std::uint64_t bytes);

/// Gives back what was reserved behind the end of a file and not written.
void release_reserved_space(const std::filesystem::path& file);

}  // namespace mssim
