#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model/system.h"

namespace mssim {

/// The neighbours of every node, ascending: node i's are neighbours[first[i]] to neighbours[first[i + 1] -
/// 1].
struct Adjacency {
  std::vector<std::uint32_t> first;       ///< [nodes + 1]
  std::vector<std::uint32_t> neighbours;  ///< [2 springs]

  Adjacency(std::size_t nodes, std::span<const Spring> springs);
  std::size_t nodes() const { return first.size() - 1; }
  std::uint32_t degree(std::uint32_t node) const { return first[node + 1] - first[node]; }
  std::span<const std::uint32_t> of(std::uint32_t node) const {
    return std::span(neighbours).subspan(first[node], degree(node));
  }
};

/// An order of the nodes in which neighbours stand near each other, so that what a node gathers lies in few
/// cache lines: breadth first from a node at the rim of its connected component, the neighbours of each node
/// by ascending degree, and each component backwards (E. Cuthill and J. McKee, 1969; A. George, 1971).
/// Components follow each other in the order of their lowest node. Returns the node at each slot: [nodes], a
/// permutation.
std::vector<std::uint32_t> reverse_cuthill_mckee(std::size_t nodes, std::span<const Spring> springs);

/// [nodes] Where each node stands in an order of them.
std::vector<std::uint32_t> places_in(std::span<const std::uint32_t> order);

/// Behind which places the connected components end, ascending, where each component's nodes stand together.
std::vector<std::size_t> component_ends(std::span<const Spring> springs,
                                        std::span<const std::uint32_t> place);

}  // namespace mssim
