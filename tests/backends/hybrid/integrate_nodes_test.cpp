// The host's part of hybrid, with forces that no device has computed.
#include "backends/hybrid/integrate_nodes.h"

#include <bit>

#include "backends/layouts/node_arrays.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

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

TEST_P(EachNodeKernel, GivesInPartsWhatTheBestOneGivesAtOnceInEveryStageOfEveryIntegrator) {
  for (const System& system : systems())
    for (const Integrator& integrator : integrators)
      expect_parts_like_the_whole<RandomStage>(kernel, node_kernels().front(), system, integrator);
}

System pinned_bodies() {
  System system = alike_bodies(pinned(solid_block(3, 4, 3), {0, 17}), 21);
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
};

class EachAlikeNodeKernel : public testing::TestWithParam<std::size_t> {
 protected:
  const NodeKernel<AlikeNodes> kernel = alike_node_kernels()[GetParam()];
};
INSTANTIATE_TEST_SUITE_P(OfThisProcessor, EachAlikeNodeKernel,
                         testing::Range(std::size_t{0}, alike_node_kernels().size()), [](const auto& test) {
                           return std::string(alike_node_kernels()[test.param].instruction_set);
                         });

TEST_P(EachAlikeNodeKernel, GivesInPartsWhatTheBestOneGivesAtOnceInEveryStageOfEveryIntegrator) {
  for (const Integrator& integrator : integrators)
    expect_parts_like_the_whole<StageOfAlikeNodes>(kernel, alike_node_kernels().front(), pinned_bodies(),
                                                   integrator);
}

}  // namespace
}  // namespace mssim
