#include "model/state_hash.h"

#include <algorithm>
#include <bit>
#include <string>

#include "text/text.h"

namespace mssim {
namespace {

void append(std::string& bytes, std::uint64_t word) {
  for (int shift = 0; shift < 64; shift += 8) bytes += static_cast<char>(word >> shift & 255U);
}

void append(std::string& bytes, const Vec3d& vector) {
  for (const double number : {vector.x, vector.y, vector.z})
    append(bytes, std::bit_cast<std::uint64_t>(number));
}

}  // namespace

std::uint64_t state_hash(const State& state) {
  std::string hashes, leaf;
  const std::size_t nodes = state.position.size();
  for (std::size_t first = 0; first < nodes; first += state_hash_leaf) {
    leaf.clear();
    for (std::size_t i = first; i < std::min(nodes, first + state_hash_leaf); ++i) {
      append(leaf, state.position[i]);
      append(leaf, state.velocity[i]);
    }
    append(hashes, fnv1a_64(leaf));
  }
  return fnv1a_64(hashes);
}

}  // namespace mssim
