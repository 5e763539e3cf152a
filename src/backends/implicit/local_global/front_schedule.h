#pragma once

#include <cstddef>
#include <vector>

#include "backends/implicit/local_global/block_factor.h"

namespace mssim {

/// Which thread passes which parts, and when. Phase 0 has whole subtrees of the tree of parts; each later
/// phase has parts whose children are done. Upwards the phases follow each other, and each thread takes its
/// items in order; downwards all is reversed. It decides nothing about the result: a part's sums are its own.
struct FrontSchedule {
  /// Parts [begin, end), children before parents.
  struct Item {
    std::size_t begin, end;
  };
  /// [phases][threads]
  std::vector<std::vector<std::vector<Item>>> phases;

  FrontSchedule(const BlockFactor& factor, std::size_t threads);
};

}  // namespace mssim
