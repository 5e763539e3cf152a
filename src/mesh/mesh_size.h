#pragma once

#include <cstdint>

namespace mssim {

/// What a scene's author got from a mesh; another TetGen may give something else, which is then said, not
/// refused.
struct MeshSize {
  std::uint32_t nodes = 0;
  std::uint32_t springs = 0;  ///< unique edges

  bool operator==(const MeshSize&) const = default;
};

}  // namespace mssim
