#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/layouts/alike_bodies.h"
#include "model/system.h"

namespace mssim {

/// Where the nodes of alike bodies lie: a slice holds one node of as many bodies as there are lanes, so that
/// the ends of a spring of all of them are two slices, [x y z u v w][lanes] each. Lanes for which there is no
/// body repeat the group's first one.
struct AlikeSlices {
  static constexpr std::size_t components = 6;

  /// As many bodies as lanes. Node i is in slice first_slice + i.
  struct Group {
    std::size_t shape;  ///< of the AlikeBodies
    std::size_t first_slice;
  };

  std::size_t lanes = 0;
  std::size_t nodes = 0;                  ///< of the scene
  std::size_t count = 0;                  ///< slices
  std::vector<Group> groups;              ///< shape after shape
  std::vector<std::uint32_t> scene_node;  ///< [slices][lanes]

  AlikeSlices(const std::vector<AlikeBodies>& bodies, std::size_t lane_count);
  std::size_t floats() const { return scene_node.size() * components; }  ///< of a pair
  /// To and from a pair, [slices][components][lanes]. Rounds to float.
  void write(const State& state, float* pair) const;
  State read(const float* pair) const;
};

}  // namespace mssim
