// The host's part of hybrid, with forces that no device has computed.
#include "backends/hybrid/host_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "backends/hybrid/integrate_nodes.h"
#include "integrators/integrators.h"
#include "tests/support/cloth_system.h"
#include "tests/support/solid_system.h"
#include "tests/support/stage_in_parts.h"

namespace mssim {
namespace {

constexpr double dt_s = 1e-3;
constexpr std::size_t record_floats = 8;

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

}  // namespace
}  // namespace mssim
