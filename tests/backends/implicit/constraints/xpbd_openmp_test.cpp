// xpbd in vectors, for every instruction set that this processor has.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "backends/implicit/constraints/step_constraints.h"
#include "backends/implicit/nodes/solvers.h"
#include "backends/vectors/step_kernels.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "tests/support/backend_step.h"
#include "tests/support/cloth_system.h"
#include "tests/support/fused_sets.h"
#include "tests/support/largest_distance.h"
#include "tests/support/solid_system.h"

namespace mssim {
namespace {

const Integrator& xpbd = *find_integrator("xpbd");

/// Single rows and columns, fewer columns than lanes, and whole vectors inside; enough rows for threads.
const std::vector<std::pair<std::uint32_t, std::uint32_t>> cloth_sizes{
    {1, 7}, {7, 1}, {2, 2}, {3, 40}, {40, 3}, {37, 23}, {50, 50}, {66, 131}, {113, 65}};

std::vector<System> solids() { return {solid_block(2, 2, 2), solid_block(9, 8, 7), two_solid_blocks()}; }

std::vector<StepKernel<QuarteredRows>> cloth_kernels() { return compiled_kernels<QuarteredRows>(); }

/// The vector code for one instruction set.
class EachXpbdKernel : public testing::TestWithParam<std::size_t> {
 protected:
  static std::unique_ptr<Backend> make(const System& system, int threads, std::size_t kernel) {
    return make_vector_backend<QuarteredRows, SpringBatches>(system, backend_dt_s, threads,
                                                             cloth_kernels()[kernel].instruction_set);
  }
  static std::unique_ptr<Backend> make(const System& system, int threads) {
    return make(system, threads, GetParam());
  }
  static void expect_reference(const System& system, const std::string& name) {
    const Reference reference = run_reference(system, xpbd, backend_dt_s);
    ASSERT_EQ(reference.steps, verification_steps);
    const Verification verification = verify(*make(system, 2), system, reference, backend_dt_s);
    EXPECT_FALSE(verification.failure) << name << ": " << verification.failure.value_or("");
  }
  /// The same bits at any number of threads, and as the best kernel that rounds alike.
  static void expect_same_bits(const System& system, const std::string& name) {
    const auto kernels = cloth_kernels();
    const auto best = std::ranges::find_if(kernels, [&](const auto& other) {
      return fuses(other.instruction_set) == fuses(kernels[GetParam()].instruction_set) &&
             other.exact_roots == kernels[GetParam()].exact_roots;
    });
    const auto alone = make(system, 1, static_cast<std::size_t>(best - kernels.begin()));
    alone->step(23);
    const State expected = alone->state();
    for (const int threads : {1, 2, 3, 7}) {
      const auto backend = make(system, threads);
      backend->step(11);
      backend->step(12);
      const State state = backend->state();
      EXPECT_EQ(state.position, expected.position) << name << ", " << threads;
      EXPECT_EQ(state.velocity, expected.velocity) << name << ", " << threads;
    }
  }
};
INSTANTIATE_TEST_SUITE_P(OfThisProcessor, EachXpbdKernel,
                         testing::Range(std::size_t{0}, cloth_kernels().size()), [](const auto& test) {
                           return std::string(cloth_kernels()[test.param].instruction_set);
                         });

TEST_P(EachXpbdKernel, AgreesWithTheReferenceOnClothsOfAnyShape) {
  for (const auto& [rows, columns] : cloth_sizes)
    expect_reference(cloth_system(rows, columns), std::to_string(rows) + " x " + std::to_string(columns));
}

TEST_P(EachXpbdKernel, AgreesWithTheReferenceOnBodies) {
  for (const System& system : solids()) expect_reference(system, std::to_string(system.nodes()) + " nodes");
}

TEST_P(EachXpbdKernel, TakesSpringsInTheOrderOfTheMethod) {
  // In steps so long that an impulse makes up for most of what the one before has done to the other springs
  // of a node.
  constexpr double long_s = 0.02;
  for (const auto& [rows, columns] : cloth_sizes) {
    System system = cloth_system(rows, columns);
    system.floor.height = -100;
    const auto reference = make_constraints_reference(system, long_s);
    const auto backend = make_vector_backend<QuarteredRows, SpringBatches>(
        system, long_s, 2, cloth_kernels()[GetParam()].instruction_set);
    reference->step(1);
    backend->step(1);
    // Roundings come to 7e-5 m/s, two colours in another order to 5e-3 or more.
    EXPECT_LT(largest_distance(backend->state().velocity, reference->state().velocity), 5e-4)
        << rows << " x " << columns;
  }
}

TEST_P(EachXpbdKernel, GivesTheSameBitsForAnyNumberOfThreads) {
  for (const auto& [rows, columns] : cloth_sizes) {
    System system = cloth_system(rows, columns);
    system.floor.height = system.start.position[0].y - 0.0001;
    expect_same_bits(system, std::to_string(rows) + " x " + std::to_string(columns));
  }
  for (const System& system : solids()) expect_same_bits(system, std::to_string(system.nodes()) + " nodes");
}

TEST_P(EachXpbdKernel, GivesTheSameBitsForAnyNumberOfSmallStepsInAPass) {
  const System system = cloth_system(113, 65);
  const auto kernel = cloth_kernels()[GetParam()];
  const auto after = [&](std::size_t depth, std::size_t threads) {
    QuarteredRows cloth(system, backend_dt_s, kernel.lanes, threads);
    cloth.depth = depth;
    cloth.set_state(system.start);
    kernel.step(cloth, 7);
    return cloth.state();
  };
  const State expected = after(1, 1);
  for (const std::size_t depth : {2U, 3U, 10U, 70U}) EXPECT_EQ(after(depth, 1).position, expected.position);
  // 29 blocks of rows are enough for three threads and two small steps.
  for (const std::size_t threads : {2U, 3U}) EXPECT_EQ(after(2, threads).position, expected.position);
  EXPECT_EQ(after(3, 2).position, expected.position);
}

/// Three equal blocks beside each other, each large enough to be a part.
System three_blocks() {
  const System block = solid_block(7, 7, 7, 0.001);
  System system = block;
  const auto nodes = static_cast<std::uint32_t>(block.nodes());
  for (std::uint32_t copy = 1; copy < 3; ++copy) {
    for (const Vec3d& x : block.start.position) system.start.position.push_back(x + Vec3d{0.5 * copy, 0, 0});
    for (const Vec3d& v : block.start.velocity) system.start.velocity.push_back(v);
    for (Spring spring : block.springs) {
      spring.first += copy * nodes;
      spring.second += copy * nodes;
      system.springs.push_back(spring);
    }
    system.node_mass.insert(system.node_mass.end(), block.node_mass.begin(), block.node_mass.end());
  }
  round_to_single(system.start);
  return system;
}

TEST_P(EachXpbdKernel, GivesTheSameBitsWhetherThreadsShareBodiesOrNot) {
  const System system = three_blocks();
  const StepKernel<SpringBatches> kernel = compiled_kernels<SpringBatches>()[GetParam()];
  const auto after = [&](std::size_t threads, std::size_t shared) {
    SpringBatches bodies(system, backend_dt_s, kernel.lanes, threads);
    EXPECT_EQ(bodies.parts.size(), 3U);
    bodies.shared_parts.clear();
    bodies.own_parts.assign(threads, {});
    for (std::size_t part = 0; part < 3; ++part)
      if (part < shared)
        bodies.shared_parts.push_back(part);
      else
        bodies.own_parts[part % threads].push_back(part);
    bodies.set_state(system.start);
    kernel.step(bodies, 21);
    return bodies.state();
  };
  const State expected = after(1, 0);
  EXPECT_TRUE(has_met_floor(system, expected));
  for (const std::size_t threads : {1U, 2U, 3U, 7U})
    for (const std::size_t shared : {0U, 1U, 3U}) {
      const State state = after(threads, shared);
      EXPECT_EQ(state.position, expected.position) << threads << ", " << shared;
      EXPECT_EQ(state.velocity, expected.velocity) << threads << ", " << shared;
    }
}

TEST_P(EachXpbdKernel, DoesEachBodyOnce) {
  for (const std::size_t threads : {1U, 2U, 3U, 7U}) {
    const SpringBatches bodies(three_blocks(), backend_dt_s, cloth_kernels()[GetParam()].lanes, threads);
    std::vector<std::size_t> done(bodies.shared_parts);
    for (const auto& parts : bodies.own_parts) done.insert(done.end(), parts.begin(), parts.end());
    std::ranges::sort(done);
    EXPECT_EQ(done, (std::vector<std::size_t>{0, 1, 2})) << threads;
  }
}

TEST_P(EachXpbdKernel, TreatsTheFloorLikeTheReference) {
  System sheet = build_system(sheet_spec(20, 37, 0.00101));
  for (Vec3d& v : sheet.start.velocity) v = {0.5, -1, 0.25};
  System block = solid_block(3, 4, 5, 0.02);
  for (Vec3d& v : block.start.velocity) v = {0.5, -4, 0.25};
  for (const System& system : {sheet, block}) {
    const auto reference = make_constraints_reference(system, backend_dt_s);
    const auto backend = make(system, 2);
    reference->step(100);
    backend->step(100);
    const State expected = reference->state(), state = backend->state();
    EXPECT_TRUE(has_met_floor(system, expected));
    for (std::size_t i = 0; i < system.nodes(); ++i) {
      EXPECT_GE(state.position[i].y, system.floor.height);
      EXPECT_NEAR(state.velocity[i].x, expected.velocity[i].x, 5e-3);
      EXPECT_NEAR(state.velocity[i].y, expected.velocity[i].y, 5e-3);
      EXPECT_NEAR(state.position[i].y, expected.position[i].y, 1e-5);
    }
  }
}

TEST_P(EachXpbdKernel, HoldsPinsExactlyWhereverTheyAreEvenBelowTheFloor) {
  SceneSpec spec = cloth_spec(20, 23);
  std::get<ClothSpec>(spec.content).pins = ClothPins{13, 5};
  System cloth = build_system(spec);
  cloth.floor.height = cloth.start.position[cloth.pins.front()].y + 0.01;
  System block = solid_block(4, 5, 6);
  block.pins = {0, 17, 118};
  for (const std::uint32_t node : block.pins) block.start.velocity[node] = {};
  for (const System& system : {cloth, block}) {
    const auto backend = make(system, 3);
    backend->step(51);
    const State state = backend->state();
    for (const std::uint32_t node : system.pins) {
      EXPECT_EQ(state.position[node], system.start.position[node]) << node;
      EXPECT_EQ(state.velocity[node], Vec3d{}) << node;
    }
    EXPECT_NE(state.position[1], system.start.position[1]) << "the others move";
  }
  expect_reference(block, "a block with pins");
}

TEST(XpbdOfOpenMp, TakesTheBestInstructionSetThatHasTheRoots) {
  for (const System& system : {cloth_system(9, 11), solid_block(3, 3, 3)}) {
    const auto device = [&](Roots roots) {
      return make_openmp_constraints(system, backend_dt_s, {.threads = 1, .roots = roots})->device();
    };
    const auto kernels = cloth_kernels();
    EXPECT_EQ(device(Roots::fast), std::string("cpu ") + kernels.front().instruction_set);
    EXPECT_EQ(device(Roots::exact),
              std::string("cpu ") +
                  std::ranges::find_if(kernels, &StepKernel<QuarteredRows>::exact_roots)->instruction_set);
  }
}

}  // namespace
}  // namespace mssim
