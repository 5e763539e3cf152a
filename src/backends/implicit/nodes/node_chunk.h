#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace mssim {

/// What a thread takes at a time, and whose sum is a number of its own: rows of a cloth or slices of bodies
/// [begin, end). Chunks depend on the system alone, so that sums over them do, too.
struct NodeChunk {
  std::size_t begin, end;
};

/// Chunks of a system: enough for the threads of one machine to have about the same work, few enough that
/// adding up their sums takes no time.
inline constexpr std::size_t most_node_chunks = 256;

/// Cuts `count` things into at most most_node_chunks chunks of about the same cost. cost_before(i): what
/// those before the i-th cost in all.
template <class CostBefore>
std::vector<NodeChunk> balanced_node_chunks(std::size_t count, CostBefore cost_before) {
  const std::size_t parts = std::min(count, most_node_chunks);
  std::vector<NodeChunk> chunks;
  std::size_t end = 0;
  for (std::size_t part = 1; part <= parts; ++part) {
    const std::size_t begin = end;
    while (end < count && cost_before(end + 1) * parts <= cost_before(count) * part) ++end;
    if (end > begin) chunks.push_back({begin, end});
  }
  return chunks;
}

}  // namespace mssim
