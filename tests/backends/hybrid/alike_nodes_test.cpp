// The host's part of hybrid for alike bodies, with forces that no device has computed.
#include "backends/hybrid/alike_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

#include "backends/hybrid/integrate_alike_nodes.h"
#include "backends/layouts/aligned_array.h"
#include "integrators/integrators.h"
#include "tests/support/solid_system.h"
#include "tests/support/stage_in_parts.h"

namespace mssim {
namespace {

constexpr double alike_dt_s = 1e-3;

System pinned_bodies() {
  System block = solid_block(3, 4, 3);
  block.pins = {0, 17};
  for (const std::uint32_t pin : block.pins) block.start.velocity[pin] = {};
  System system = alike_bodies(block, 21);
  system.floor.height = -10;
  return system;
}

/// Random accelerations of the first ends of all springs, and pairs that begin as the system does.
struct StageOfAlikeNodes {
  AlikeNodes nodes;
  AlignedArray forces;
  std::array<AlignedArray, pair_kinds> pairs;
  MappedNodes mapped;

  StageOfAlikeNodes(const System& system, const Integrator& integrator)
      : nodes(system, *find_alike_bodies(system), integrator, alike_dt_s),
        forces(nodes.springs.springs.size() * 3 * AlikeSprings::slice_nodes) {
    std::mt19937 random(5);
    for (std::size_t i = 0; i < forces.size(); ++i)
      forces.data()[i] = static_cast<float>(random()) / 4294967296.0F - 0.5F;
    for (std::size_t pair = 0; pair < pair_kinds; ++pair) {
      pairs[pair] = AlignedArray(nodes.springs.slices.floats());
      nodes.write(system.start, pairs[pair].data());
      mapped.pairs[pair] = pairs[pair].data();
    }
    mapped.forces = forces.data();
  }
  /// Of a lane.
  Vec3d force(std::size_t spring, std::size_t lane) const {
    const float* of = forces.data() + spring * 3 * AlikeSprings::slice_nodes + lane;
    return {of[0], of[AlikeSprings::slice_nodes], of[2 * AlikeSprings::slice_nodes]};
  }
};

class EachAlikeNodeKernel : public testing::TestWithParam<std::size_t> {
 protected:
  const NodeKernel<AlikeNodes> kernel = alike_node_kernels()[GetParam()];
};
INSTANTIATE_TEST_SUITE_P(OfThisProcessor, EachAlikeNodeKernel,
                         testing::Range(std::size_t{0}, alike_node_kernels().size()), [](const auto& test) {
                           return std::string(alike_node_kernels()[test.param].instruction_set);
                         });

TEST_P(EachAlikeNodeKernel, AddsAForceAtTheFirstEndSubtractsItAtTheSecondAndTakesTheStep) {
  const System system = pinned_bodies();
  const StageOfAlikeNodes stage(system, integrators[0]);
  const AlikeSlices& slices = stage.nodes.springs.slices;
  std::vector<Vec3d> a(system.nodes());
  for (std::size_t s = 0; s < stage.nodes.springs.springs.size(); ++s) {
    const AlikeSprings::SpringOfSlices& spring = stage.nodes.springs.springs[s];
    for (std::size_t lane = 0; lane < AlikeSprings::slice_nodes; ++lane) {
      const std::size_t slot = spring.first * AlikeSprings::slice_nodes + lane;
      if (lane > 0 && slices.scene_node[slot] == slices.scene_node[slot - lane]) continue;  // repeats
      a[slices.scene_node[slot]] += stage.force(s, lane);
      a[slices.scene_node[spring.second * AlikeSprings::slice_nodes + lane]] -= stage.force(s, lane);
    }
  }
  kernel.integrate(stage.nodes, stage.mapped, 0, 0, slices.count);
  // What repeats the first body of a group has other forces here: read() takes the lane behind the others.
  const float* next = stage.mapped.pairs[index(Pair::next)];
  std::vector<bool> seen(system.nodes(), false);
  for (std::size_t slot = 0; slot < slices.scene_node.size(); ++slot) {
    const std::uint32_t node = slices.scene_node[slot];
    if (seen[node]) continue;
    seen[node] = true;
    const float* of = next + slot / 16 * 96 + slot % 16;
    const Vec3d x = system.start.position[node], v = system.start.velocity[node];
    Vec3d expected = v + alike_dt_s * (a[node] - system.viscous_damping * v - Vec3d{0, system.gravity, 0});
    if (std::ranges::count(system.pins, node) > 0) expected = {};
    const Vec3d found{of[48], of[64], of[80]};
    EXPECT_LT(length(found - expected), 1e-6) << node;
    EXPECT_LT(length(Vec3d{of[0], of[16], of[32]} - (x + alike_dt_s * expected)), 1e-6) << node;
  }
  EXPECT_EQ(std::ranges::count(seen, true), system.nodes());
}

TEST_P(EachAlikeNodeKernel, GivesInPartsWhatTheBestOneGivesAtOnceInEveryStageOfEveryIntegrator) {
  for (const Integrator& integrator : integrators)
    expect_parts_like_the_whole<StageOfAlikeNodes>(kernel, alike_node_kernels().front(), pinned_bodies(),
                                                   integrator);
}

}  // namespace
}  // namespace mssim
