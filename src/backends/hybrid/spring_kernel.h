#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace mssim {

/// How a device computes the forces of springs that lie in some layout.
struct SpringKernel {
  std::string text;  ///< of the program
  const char* name;  ///< of its kernel
  /// What a work-item takes some of in turn: its last arguments are how many there are and how many it takes.
  std::size_t parts;
  std::size_t pair_floats, force_floats;  ///< its first two arguments: a pair of nodes, the forces
  std::vector<std::span<const std::byte>> constants;  ///< the arguments between these
};

}  // namespace mssim
