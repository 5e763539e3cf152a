#pragma once

#include <cstddef>
#include <cstdint>

#include "model/system.h"

namespace mssim {

/// Nodes of a leaf of state_hash.
inline constexpr std::size_t state_hash_leaf = 4096;

/// Two states have the same hash if they agree to the last bit; others, but by accident, do not. It is a tree
/// of two levels, so that who holds only a part of the nodes can hash that part: FNV-1a of each 4096 nodes
/// (the six numbers of a node after each other, position before velocity, each a double from its lowest byte
/// on), and FNV-1a of these hashes in their order, each from its lowest byte on.
std::uint64_t state_hash(const State& state);

}  // namespace mssim
