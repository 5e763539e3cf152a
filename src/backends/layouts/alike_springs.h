#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/layouts/alike_slices.h"

namespace mssim {

/// The springs of alike bodies as `hybrid` shares them between device and host, in place of PackedSprings:
/// the device computes the forces of a spring of sixteen bodies side by side (kernels/alike_springs.cl), and
/// the host sums for every slice whole vectors of forces. Constants are divided by a node's mass, so that
/// forces are accelerations.
struct AlikeSprings {
  static constexpr std::size_t slice_nodes = 16;

  /// The springs of one group of bodies.
  struct SpringOfSlices {
    std::uint32_t first, second;  ///< slices
    float stiffness_rest;         ///< AlikeBodies::SpringAhead::stiffness_rest
    std::uint32_t shape;
  };
  struct ShapeConstants {
    float stiffness, damping;  ///< AlikeBodies::stiffness, damping
  };

  AlikeSlices slices;
  std::vector<ShapeConstants> shapes;
  std::vector<std::uint8_t> pinned;     ///< [slices] 1 where nodes are, else 0
  std::vector<SpringOfSlices> springs;  ///< ascending by first, then by second slice
  std::vector<std::uint32_t>
      first_end;  ///< [slices + 1] where in `springs` those begin that begin at a slice
  /// [slices + 1] where in `subtracted` the springs of a slice begin, which are the springs that end there.
  std::vector<std::uint32_t> first_subtracted;
  std::vector<std::uint32_t> subtracted;  ///< [springs] ascending within a slice

  /// Throws Unsupported for more springs than 32 bits number for each lane.
  explicit AlikeSprings(const std::vector<AlikeBodies>& bodies);
};

}  // namespace mssim
