#include "backends/layouts/alike_springs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "tests/support/solid_system.h"

namespace mssim {
namespace {

TEST(AlikeSprings, GiveEachSpringOfEachBodyToBothOfItsEndsOnce) {
  System block = solid_block(3, 4, 3);
  block.pins = {5};
  block.start.velocity[5] = {};
  System system = alike_bodies(block, 19);
  append_body(system, alike_bodies(solid_block(2, 2, 2), 3), {0, 0, 1});
  const AlikeSprings springs(*find_alike_bodies(system));
  const AlikeSlices& slices = springs.slices;
  ASSERT_EQ(springs.pinned.size(), slices.count);
  ASSERT_EQ(springs.first_end.size(), slices.count + 1);
  ASSERT_EQ(springs.first_subtracted.size(), slices.count + 1);
  EXPECT_EQ(std::ranges::count(springs.pinned, 1), 2) << "a node of two groups";

  std::map<std::pair<std::uint32_t, std::uint32_t>, float> expected, found;
  for (const Spring& spring : system.springs)
    expected[std::minmax(spring.first, spring.second)] =
        static_cast<float>(200 * static_cast<double>(spring.rest_length) / 0.004);
  std::vector<int> subtracted(springs.springs.size(), 0);
  for (std::uint32_t slice = 0; slice < slices.count; ++slice) {
    const std::uint32_t pin = slices.scene_node[slice * AlikeSprings::slice_nodes];
    EXPECT_EQ(springs.pinned[slice], std::ranges::count(system.pins, pin));
    for (std::uint32_t s = springs.first_end[slice]; s < springs.first_end[slice + 1]; ++s) {
      const AlikeSprings::SpringOfSlices& spring = springs.springs[s];
      EXPECT_EQ(spring.first, slice);
      for (std::size_t lane = 0; lane < AlikeSprings::slice_nodes; ++lane)
        found[std::minmax(slices.scene_node[spring.first * AlikeSprings::slice_nodes + lane],
                          slices.scene_node[spring.second * AlikeSprings::slice_nodes + lane])] =
            spring.stiffness_rest;
      EXPECT_EQ(springs.shapes[spring.shape].stiffness, static_cast<float>(200 / 0.004));
      EXPECT_EQ(springs.shapes[spring.shape].damping, static_cast<float>(0.05 / 0.004));
    }
    for (std::uint32_t i = springs.first_subtracted[slice]; i < springs.first_subtracted[slice + 1]; ++i) {
      EXPECT_EQ(springs.springs[springs.subtracted[i]].second, slice);
      ++subtracted[springs.subtracted[i]];
    }
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(springs.first_end.back(), springs.springs.size());
  EXPECT_EQ(std::ranges::count(subtracted, 1), springs.springs.size());
}

}  // namespace
}  // namespace mssim
