#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

namespace mssim {

/// Why a file cannot be read as a whole. what() is the problem alone, such as "is not a regular file".
struct ReadError : std::runtime_error {
  enum class Cause { missing, not_regular, too_large, other };
  Cause cause;

  ReadError(Cause why, const std::string& problem) : std::runtime_error(problem), cause(why) {}

  /// "FILE: PROBLEM: REMEDY". The problem says itself what to do about an `other` cause.
  std::string sentence(const std::filesystem::path& file, std::string_view remedy) const;
};

/// Throws ReadError unless there is such a file and it is a regular one.
void require_regular_file(const std::filesystem::path& file);

/// All bytes of a regular file: a pipe would block, a device may never end, and a folder reads as nothing.
/// Throws ReadError, also where there are more than `most_bytes`.
std::string read_file(const std::filesystem::path& file,
                      std::size_t most_bytes = std::numeric_limits<std::size_t>::max());

}  // namespace mssim
