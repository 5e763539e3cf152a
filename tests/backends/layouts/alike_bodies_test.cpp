#include "backends/layouts/alike_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "tests/support/solid_system.h"

namespace mssim {
namespace {

TEST(AlikeBodies, AreThoseOfTheSameSprings) {
  System system = alike_bodies(solid_block(3, 4, 3), 5);
  append_body(system, solid_block(2, 2, 2), {5, 0, 0});
  append_body(system, solid_block(3, 4, 3), {6, 0, 0});
  const auto found = find_alike_bodies(system);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2U);
  EXPECT_EQ(found->front().nodes(), 36U);
  EXPECT_EQ(found->front().bodies.size(), 6U);
  EXPECT_EQ(found->back().nodes(), 8U);
  EXPECT_EQ(found->back().bodies.size(), 1U);
}

TEST(AlikeBodies, HaveEverySpringOfEachBodyFromTheFirstOfItsEnds) {
  const System system = alike_bodies(solid_block(3, 4, 3), 3);
  const AlikeBodies alike = find_alike_bodies(system)->front();
  std::map<std::pair<std::uint32_t, std::uint32_t>, float> expected, found;
  for (const Spring& spring : system.springs)
    expected[std::minmax(spring.first, spring.second)] = static_cast<float>(
        system.materials[spring.kind].stiffness * static_cast<double>(spring.rest_length) / 0.004);
  std::vector<bool> seen(system.nodes(), false);
  for (const std::vector<std::uint32_t>& body : alike.bodies) {
    ASSERT_EQ(body.size(), alike.nodes());
    for (const std::uint32_t node : body) seen[node] = true;
    for (std::uint32_t node = 0; node < alike.nodes(); ++node)
      for (std::uint32_t s = alike.first_spring[node]; s < alike.first_spring[node + 1]; ++s) {
        const AlikeBodies::SpringAhead& spring = alike.springs[s];
        EXPECT_GT(spring.other, s > alike.first_spring[node] ? alike.springs[s - 1].other : node);
        found[std::minmax(body[node], body[spring.other])] = spring.stiffness_rest;
      }
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(std::ranges::count(seen, true), system.nodes());
  EXPECT_EQ(alike.stiffness, static_cast<float>(200 / 0.004));
  EXPECT_EQ(alike.damping, static_cast<float>(0.05 / 0.004));
}

TEST(AlikeBodies, AreToldApartByAnythingThatSpringsOrNodesHave) {
  const System block = solid_block(3, 3, 3);
  const std::pair<const char*, std::function<void(System&)>> changes[] = {
      {"a rest length", [](System& body) { body.springs[7].rest_length *= 1.001F; }},
      {"a spring less", [](System& body) { body.springs.erase(body.springs.begin() + 11); }},
      {"stiffness", [](System& body) { body.materials[0].stiffness *= 2; }},
      {"damping", [](System& body) { body.materials[0].damping *= 2; }},
      {"masses", [](System& body) { body.node_mass.assign(body.nodes(), 0.005); }},
      {"a pin", [](System& body) {
         body.pins = {4};
         body.start.velocity[4] = {};
       }}};
  for (const auto& [what, change] : changes) {
    System system = alike_bodies(block, 2), other = block;
    change(other);
    append_body(system, other, {2, 0, 0});
    const auto found = find_alike_bodies(system);
    ASSERT_TRUE(found) << what;
    ASSERT_EQ(found->size(), 2U) << what;
    EXPECT_EQ(found->front().bodies.size(), 2U) << what;
  }
}

TEST(AlikeBodies, AreNotSoughtWhereNodesThatSpringsJoinAreUnlike) {
  System masses = alike_bodies(solid_block(2, 2, 2), 2);
  masses.node_mass[3] *= 1.5;
  EXPECT_FALSE(find_alike_bodies(masses));
  System materials = alike_bodies(solid_block(2, 2, 2), 2);
  materials.materials.push_back({100, 0});
  materials.springs[3].kind = 2;
  EXPECT_FALSE(find_alike_bodies(materials));
}

TEST(AlikeBodies, AreForLanesWhereTheyAreMany) {
  const System block = solid_block(3, 3, 3);
  EXPECT_FALSE(alike_bodies_for(block, 16, 3));
  EXPECT_FALSE(alike_bodies_for(alike_bodies(block, 5), 16, 3));
  EXPECT_TRUE(alike_bodies_for(alike_bodies(block, 6), 16, 3));
  EXPECT_FALSE(alike_bodies_for(alike_bodies(block, 6), 16, 2));
  EXPECT_TRUE(alike_bodies_for(alike_bodies(block, 8), 16, 2));
  EXPECT_TRUE(alike_bodies_for(alike_bodies(block, 3), 8, 3));
  EXPECT_FALSE(alike_bodies_for(block, 4, 3));
  EXPECT_TRUE(alike_bodies_for(alike_bodies(block, 2), 4, 3));
  EXPECT_TRUE(alike_bodies_for(block, 1, 3));
  System mixed = alike_bodies(block, 16);
  EXPECT_TRUE(alike_bodies_for(mixed, 16, 3));
  append_body(mixed, solid_block(9, 9, 9), {9, 0, 0});
  EXPECT_FALSE(alike_bodies_for(mixed, 16, 3)) << "most of its springs are in one body";
  System unlike = alike_bodies(block, 16);
  unlike.node_mass[3] *= 2;
  EXPECT_FALSE(alike_bodies_for(unlike, 16, 3));
}

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
