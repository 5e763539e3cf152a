#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace mssim {

/// The installed TetGen.
struct TetgenProgram {
  std::filesystem::path executable;
  std::string version;  ///< as it calls itself, for example "1.5", or "unknown"
  /// Of the program and its library: what distinguishes two TetGens that call themselves the same.
  std::uint64_t fnv1a_64 = 0;
};

/// The `tetgen` that PATH finds, or nothing.
std::optional<TetgenProgram> find_tetgen();

}  // namespace mssim
