#pragma once

#include <cstdint>

namespace mssim {

/// What a rank has done for others in all its steps so far.
struct RankCosts {
  double waited_s = 0;         ///< for messages that the next columns or nodes needed
  double packed_s = 0;         ///< bringing together what was sent, and putting in place what came
  std::uint64_t bytes = 0;     ///< sent
  std::uint64_t messages = 0;  ///< the same
};

}  // namespace mssim
