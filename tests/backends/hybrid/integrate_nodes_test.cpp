// The host's part of hybrid, with forces that no device has computed.
#include "backends/hybrid/integrate_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "backends/layouts/node_arrays.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "tests/support/systems.h"

namespace mssim {
namespace {

constexpr double dt_s = 1e-3;
constexpr std::size_t record_floats = 8;

/// Every stage of an integrator on the host's part of hybrid: in two parts by `kernel` as by `best` at once.
/// `StageOfNodes`, made of a system and an integrator, has `nodes`, `pairs` and `mapped`.
template <class StageOfNodes, class Kernel>
void expect_parts_like_the_whole(const Kernel& kernel, const Kernel& best, const System& system,
                                 const Integrator& integrator) {
  const StageOfNodes expected(system, integrator), found(system, integrator);
  const std::size_t slices = expected.nodes.slices();
  for (std::size_t stage = 0; stage < integrator.stage_count; ++stage) {
    best.integrate(expected.nodes, expected.mapped, stage, 0, slices);
    kernel.integrate(found.nodes, found.mapped, stage, slices / 3, slices);
    kernel.integrate(found.nodes, found.mapped, stage, 0, slices / 3);
  }
  for (std::size_t pair = 0; pair < pair_kinds; ++pair)
    for (std::size_t i = 0; i < expected.pairs[pair].size(); ++i)
      ASSERT_NEAR(found.mapped.pairs[pair][i], expected.mapped.pairs[pair][i],
                  1e-5 * (1 + std::abs(expected.mapped.pairs[pair][i])))
          << integrator.name << ", pair " << pair;
}

/// Random forces on the first ends of a system's springs, and all pairs of an integrator at random.
struct RandomStage {
  HostNodes nodes;
  AlignedArray forces;
  std::array<AlignedArray, pair_kinds> pairs;
  MappedNodes mapped;

  RandomStage(const System& system, const Integrator& integrator)
      : nodes(system, integrator, dt_s), forces(4 * (nodes.packed.unit_count() + 1)) {
    std::mt19937 random(5);
    const auto number = [&] { return static_cast<float>(random()) / 4294967296.0F - 0.5F; };
    for (std::size_t entry = 0; entry < nodes.packed.entries.size(); ++entry)
      for (std::size_t node = 0; node < PackedSprings::slice_nodes; ++node) {
        if (rest_length(entry, node) == PackedSprings::empty_unit) continue;
        for (std::size_t i = 0; i < 3; ++i) force(entry, node)[i] = number();
      }
    for (std::size_t pair = 0; pair < pair_kinds; ++pair) {
      pairs[pair] = AlignedArray(nodes.packed.slots() * record_floats);
      for (std::size_t i = 0; i < pairs[pair].size(); ++i)
        if (i % 4 != 3) pairs[pair].data()[i] = 1 + number();
      mapped.pairs[pair] = pairs[pair].data();
    }
    mapped.forces = forces.data();
  }

  float* force(std::size_t entry, std::size_t node) {
    return forces.data() + 4 * (entry * PackedSprings::slice_nodes + PackedSprings::force_place(node));
  }
  float rest_length(std::size_t entry, std::size_t node) const {
    return std::bit_cast<float>(nodes.packed.units[(2 * entry + 1) * PackedSprings::slice_nodes + node]);
  }
};

std::vector<System> systems() {
  std::vector<System> all{solid_block(2, 2, 2), solid_block(9, 9, 9), two_solid_blocks(),
                          cloth_system(13, 9)};
  all[1].pins = {0, 17, 300};
  return all;
}

class EachNodeKernel : public testing::TestWithParam<std::size_t> {
 protected:
  const NodeKernel<HostNodes> kernel = node_kernels()[GetParam()];
};
INSTANTIATE_TEST_SUITE_P(OfThisProcessor, EachNodeKernel,
                         testing::Range(std::size_t{0}, node_kernels().size()), [](const auto& test) {
                           return std::string(node_kernels()[test.param].instruction_set);
                         });

TEST_P(EachNodeKernel, AddsAForceAtTheFirstEndSubtractsItAtTheSecondAndTakesTheStep) {
  for (System system : systems()) {
    system.floor.height = -10;
    RandomStage stage(system, integrators[0]);
    const PackedSprings& packed = stage.nodes.packed;
    std::vector<Vec3d> force(packed.slots());
    for (std::size_t entry = 0; entry < packed.entries.size(); ++entry)
      for (std::size_t i = 0; i < PackedSprings::slice_nodes; ++i) {
        const float* f = stage.force(entry, i);
        const Vec3d on_first{f[0], f[1], f[2]};
        Vec3d& first = force[packed.entries[entry].slice * PackedSprings::slice_nodes + i];
        Vec3d& second = force[packed.units[2 * entry * PackedSprings::slice_nodes + i]];
        first = first + on_first;
        second = second - on_first;
      }
    const AlignedArray before = std::move(stage.pairs[index(Pair::state)]);
    stage.pairs[index(Pair::state)] = AlignedArray(before.size());
    std::copy_n(before.data(), before.size(), stage.pairs[index(Pair::state)].data());
    stage.mapped.pairs[index(Pair::state)] = stage.pairs[index(Pair::state)].data();
    kernel.integrate(stage.nodes, stage.mapped, 0, 0, packed.slices());
    for (std::uint32_t node = 0; node < system.nodes(); ++node) {
      const std::size_t at = packed.slot[node] * record_floats;
      const bool held = std::find(system.pins.begin(), system.pins.end(), node) != system.pins.end();
      const float *old = before.data() + at, *next = stage.mapped.pairs[index(Pair::next)] + at;
      const Vec3d f = force[packed.slot[node]];
      for (std::size_t i = 0; i < 3; ++i) {
        const double spring = (i == 0 ? f.x : i == 1 ? f.y : f.z) / system.node_mass[node];
        const double a =
            held ? 0 : spring - system.viscous_damping * old[4 + i] - (i == 1 ? system.gravity : 0);
        const double v = old[4 + i] + dt_s * a;
        EXPECT_NEAR(next[4 + i], v, 1e-5 * (1 + std::abs(dt_s * spring))) << system.nodes() << ": " << node;
        EXPECT_NEAR(next[i], old[i] + dt_s * v, 1e-6) << system.nodes() << " nodes, node " << node;
      }
    }
  }
}

TEST_P(EachNodeKernel, GivesInPartsWhatTheBestOneGivesAtOnceInEveryStageOfEveryIntegrator) {
  for (const System& system : systems())
    for (const Integrator& integrator : integrators)
      expect_parts_like_the_whole<RandomStage>(kernel, node_kernels().front(), system, integrator);
}

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
      : nodes(system, *find_alike_bodies(system), integrator, dt_s),
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
    Vec3d expected = v + dt_s * (a[node] - system.viscous_damping * v - Vec3d{0, system.gravity, 0});
    if (std::ranges::count(system.pins, node) > 0) expected = {};
    const Vec3d found{of[48], of[64], of[80]};
    EXPECT_LT(length(found - expected), 1e-6) << node;
    EXPECT_LT(length(Vec3d{of[0], of[16], of[32]} - (x + dt_s * expected)), 1e-6) << node;
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
