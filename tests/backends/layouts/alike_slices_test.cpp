#include "backends/layouts/alike_slices.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/solid_system.h"

namespace mssim {
namespace {

TEST(AlikeSlices, HoldEveryNodeInTheLaneOfItsBody) {
  System system = alike_bodies(solid_block(3, 4, 3), 11);
  append_body(system, solid_block(2, 2, 2), {9, 0, 0});
  const std::vector<AlikeBodies> bodies = *find_alike_bodies(system);
  for (const std::size_t lanes : {1U, 4U, 8U, 16U}) {
    const AlikeSlices slices(bodies, lanes);
    EXPECT_EQ(slices.nodes, system.nodes());
    ASSERT_EQ(slices.groups.size(), (11 + lanes - 1) / lanes + 1);
    std::size_t next = 0;
    for (const AlikeSlices::Group& group : slices.groups) {
      EXPECT_EQ(group.first_slice, next);
      next += bodies[group.shape].nodes();
    }
    EXPECT_EQ(next, slices.count);
    for (std::size_t group = 0; group + 1 < slices.groups.size(); ++group)
      for (std::size_t node = 0; node < 36; ++node)
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const std::size_t body = group * lanes + lane;
          EXPECT_EQ(slices.scene_node[(slices.groups[group].first_slice + node) * lanes + lane],
                    bodies[0].bodies[body < 11 ? body : group * lanes][node]);
        }
    std::vector<float> pair(slices.floats(), -1);
    slices.write(system.start, pair.data());
    for (std::size_t i = 0; i < slices.scene_node.size(); ++i) {
      const Vec3d x = system.start.position[slices.scene_node[i]],
                  v = system.start.velocity[slices.scene_node[i]];
      const float* of_slice = pair.data() + i / lanes * 6 * lanes + i % lanes;
      EXPECT_EQ((Vec3d{of_slice[0], of_slice[lanes], of_slice[2 * lanes]}), x);
      EXPECT_EQ((Vec3d{of_slice[3 * lanes], of_slice[4 * lanes], of_slice[5 * lanes]}), v);
    }
    const State state = slices.read(pair.data());
    EXPECT_EQ(state.position, system.start.position);
    EXPECT_EQ(state.velocity, system.start.velocity);
  }
}

}  // namespace
}  // namespace mssim
