#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace mssim {

/// What control groups (cgroups) let this process have, as containers, Slurm and systemd set them: of the
/// group that it is in and of those that this is in, each the least. None where there is no limit.
struct ContainerLimits {
  std::optional<double> processors;           ///< processor seconds a second
  std::optional<std::uint64_t> memory_bytes;  ///< the limit
  /// Bytes of it that are not in use; the kernel gives up its copies of files before it refuses memory, so
  /// that they count as unused.
  std::optional<std::uint64_t> memory_left;
};

/// Asks cgroups of version 1 and 2. `root` stands before /proc and the folders where cgroups are mounted.
ContainerLimits container_limits(const std::filesystem::path& root = "/");

}  // namespace mssim
