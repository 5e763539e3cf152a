#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model/system.h"

namespace mssim {

/// Springs by the end that comes first in an order of their nodes: found by counting, since sorting a copy of
/// all springs takes four times as long on a large cloth.
class SpringsByFirstEnd {
 public:
  /// `slot`: [nodes] where each node stands; `rank`: [nodes] how far ahead it is, by which first ends are
  /// chosen. The springs, and both, must outlive this.
  SpringsByFirstEnd(std::span<const Spring> springs, std::span<const std::uint32_t> slot,
                    std::span<const std::uint32_t> rank);

  /// Numbers of the springs that begin at a slot, ascending; none at a slot without a node.
  std::span<const std::uint32_t> at(std::size_t slot) const {
    if (slot + 1 >= begin_.size()) return {};
    return std::span(order_).subspan(begin_[slot], begin_[slot + 1] - begin_[slot]);
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
  std::vector<std::uint32_t> begin_;  // [nodes + 1]
  std::vector<std::uint32_t> order_;  // [springs]
};

}  // namespace mssim
