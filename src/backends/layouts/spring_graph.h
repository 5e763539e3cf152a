#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "backends/layouts/grouped.h"
#include "model/system.h"

namespace mssim {

/// [nodes] number of springs at each node.
std::vector<std::uint32_t> degrees_of(std::size_t nodes, std::span<const Spring> springs);

/// The neighbours of every node, ascending: `items` has two for each spring, `first` [nodes + 1] begins.
struct Adjacency : Grouped<std::uint32_t> {
  /// `links`: springs, or others with a `first` and a `second` node.
  template <class Links>
  Adjacency(std::size_t nodes, const Links& links)
      : Grouped(nodes, [&](const auto& visit) {
          for (const auto& link : links) {
            visit(link.first, link.second);
            visit(link.second, link.first);
          }
        }) {
    for (std::size_t node = 0; node < nodes; ++node)
      std::sort(items.begin() + first[node], items.begin() + first[node + 1]);
  }
  std::uint32_t degree(std::uint32_t node) const { return first[node + 1] - first[node]; }
};

/// An order of the nodes in which neighbours are near each other, so that a node gathers from few cache
/// lines: breadth first from a peripheral node of each connected component, the neighbours of each node by
/// ascending degree, and each component reversed (E. Cuthill and J. McKee, 1969; A. George, 1971). Components
/// are in the order of their lowest nodes. Returns the node at each slot: [nodes], a permutation.
std::vector<std::uint32_t> reverse_cuthill_mckee(std::size_t nodes, std::span<const Spring> springs);

/// [nodes] the position of each node in an order of them.
std::vector<std::uint32_t> places_in(std::span<const std::uint32_t> order);

/// Ends of the connected components in an order in which each component's nodes are contiguous, ascending.
std::vector<std::size_t> component_ends(std::span<const Spring> springs,
                                        std::span<const std::uint32_t> place);

/// Springs by the end that comes first in an order of their nodes: a counting sort, because sorting a copy of
/// all springs takes four times as long on a large cloth.
class SpringsByFirstEnd {
 public:
  /// `slot`: [nodes] the slot of each node; `rank`: [nodes] the position by which first ends are chosen. The
  /// springs and both arrays must outlive this object.
  SpringsByFirstEnd(std::span<const Spring> springs, std::span<const std::uint32_t> slot,
                    std::span<const std::uint32_t> rank);

  /// Indices of the springs that begin at a slot, ascending; empty for a slot without a node.
  std::span<const std::uint32_t> at(std::size_t slot) const {
    if (slot >= by_slot_.groups()) return {};
    return by_slot_.of(slot);
  }
  /// The slot of a spring's second end.
  std::uint32_t second_slot(const Spring& spring) const {
    return slot_[begins_at_first(spring) ? spring.second : spring.first];
  }

 private:
  bool begins_at_first(const Spring& spring) const { return rank_[spring.first] < rank_[spring.second]; }
  std::uint32_t first_slot(const Spring& spring) const {
    return slot_[begins_at_first(spring) ? spring.first : spring.second];
  }

  std::span<const std::uint32_t> slot_, rank_;
  Grouped<std::uint32_t> by_slot_;
};

/// A list of springs by colour: no two springs of a colour share a node.
using SpringColouring = Grouped<Spring, std::size_t>;

/// Gives each spring in turn the first colour that neither of its ends has: at most twice the largest degree
/// of a node, minus one, colours. `nodes`: greater than all node numbers of the springs.
SpringColouring colour_springs(std::span<const Spring> list, std::size_t nodes);

}  // namespace mssim
