// What xpbd computes, against what is known without it, and the order in which it takes springs.

#include "backends/backends.h"
#include "backends/implicit/constraints/step_constraints.h"
#include "backends/implicit/nodes/solvers.h"
#include "backends/vectors/step_kernels.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "integrators/stability.h"
#include "model/system.h"
#include "tests/support/backend_checks.h"
#include "tests/support/expect_coloured.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

const Integrator& xpbd = *find_integrator("xpbd");

TEST(SpringOrder, HasTwelveColoursOfAClothInWhichNoTwoSpringsShareANode) {
  for (const auto& [rows, columns] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{
           {1, 7}, {7, 1}, {2, 2}, {3, 40}, {40, 3}, {37, 23}, {50, 50}}) {
    const System system = cloth_system(rows, columns);
    const SpringColouring order = spring_order(system);
    EXPECT_EQ(order.groups(), 12U) << rows << " x " << columns;
    expect_coloured(order, system.springs);
  }
}

TEST(SpringOrder, GivesEachSpringTheColourOfItsPlace) {
  using Ends = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  const auto ends = [](const System& system, ClothColour colour) {
    const SpringColouring order = spring_order(system);
    Ends found;
    for (const Spring& spring : order.of(colour))
      found.emplace_back(std::minmax(spring.first, spring.second));
    std::ranges::sort(found);
    return found;
  };
  // A row or a column of seven nodes.
  const System row = cloth_system(1, 7), column = cloth_system(7, 1);
  EXPECT_EQ(ends(row, structural_from_even_columns), (Ends{{0, 1}, {2, 3}, {4, 5}}));
  EXPECT_EQ(ends(row, structural_from_odd_columns), (Ends{{1, 2}, {3, 4}, {5, 6}}));
  EXPECT_EQ(ends(row, bending_from_columns_01), (Ends{{0, 2}, {1, 3}, {4, 6}}));
  EXPECT_EQ(ends(row, bending_from_columns_23), (Ends{{2, 4}, {3, 5}}));
  EXPECT_EQ(ends(column, structural_below_even_rows), (Ends{{0, 1}, {2, 3}, {4, 5}}));
  EXPECT_EQ(ends(column, structural_below_odd_rows), (Ends{{1, 2}, {3, 4}, {5, 6}}));
  EXPECT_EQ(ends(column, bending_below_rows_01), (Ends{{0, 2}, {1, 3}, {4, 6}}));
  EXPECT_EQ(ends(column, bending_below_rows_23), (Ends{{2, 4}, {3, 5}}));
  // Three rows of two: 0 1 / 2 3 / 4 5.
  const System rows = cloth_system(3, 2);
  EXPECT_EQ(ends(rows, falling_below_even_rows), (Ends{{0, 3}}));
  EXPECT_EQ(ends(rows, falling_below_odd_rows), (Ends{{2, 5}}));
  EXPECT_EQ(ends(rows, rising_below_even_rows), (Ends{{1, 2}}));
  EXPECT_EQ(ends(rows, rising_below_odd_rows), (Ends{{3, 4}}));
}

TEST(SpringOrder, OfBodiesIsThatOfTheGreedyColouring) {
  for (const System& system : {solid_block(5, 6, 7), two_solid_blocks()}) {
    const SpringColouring order = spring_order(system);
    expect_coloured(order, system.springs);
    EXPECT_EQ(order.groups(), colour_springs(system.springs, system.nodes()).groups());
  }
}

/// Two nodes of 1 and 0.5 kg joined by a spring of 1 m, along x, which is stretched by half a metre, and a
/// third one alone; no gravity.
System one_spring(SpringMaterial material) {
  System system;
  system.topology = TetrahedralMesh{};
  system.springs = {{0, 1, 1, 0}};
  system.materials = {material};
  system.node_mass = {1, 0.5, 2};
  system.start.position = {{0, 5, 0}, {1.5, 5, 0}, {0, 8, 0}};
  system.start.velocity = {{}, {}, {1, 2, 3}};
  return system;
}

/// Every way to take steps of xpbd.
std::vector<std::unique_ptr<Backend>> all_backends(const System& system, double dt_s) {
  std::vector<std::unique_ptr<Backend>> backends;
  backends.push_back(make_reference(system, xpbd, dt_s));
  backends.push_back(make_serial_constraints(system, xpbd, dt_s, {}));
  backends.push_back(make_openmp_constraints(system, xpbd, dt_s, {2, ""}));
  return backends;
}

TEST(Xpbd, TakesASmallStepOfOneSpringAsWorkedOutByHand) {
  // h = 0.1 s, h^2 k = 1, h c = 0.5, w1 + w2 = 3 / kg: the impulse is h k 0.5 m / (1 + 1.5 * 3) = 10/11 N s.
  System system = one_spring({100, 5});
  system.solver.substeps = 1;
  for (const auto& backend : all_backends(system, 0.1)) {
    const State state = state_after(*backend, 1);
    EXPECT_NEAR(state.velocity[0].x, 10.0 / 11, 1e-6);
    EXPECT_NEAR(state.velocity[1].x, -20.0 / 11, 1e-6);
    EXPECT_NEAR(state.position[0].x, 1.0 / 11, 1e-7);
    EXPECT_NEAR(state.position[1].x, 1.5 - 2.0 / 11, 1e-6);
    EXPECT_EQ(state.position[0].y, 5);
    EXPECT_EQ(state.velocity[1].z, 0);
  }
}

TEST(Xpbd, LetsNodesFallThroughViscousAirImplicitly) {
  System system = one_spring({0, 0});
  system.gravity = 10;
  system.viscous_damping = 0.5;
  system.solver.substeps = 2;
  // Twice h = 0.1 s: v = (v - h g) / 1.05.
  const double first = (2 - 1) / 1.05, second = (first - 1) / 1.05;
  for (const auto& backend : all_backends(system, 0.2)) {
    const State state = state_after(*backend, 1);
    EXPECT_NEAR(state.velocity[2].y, second, 1e-6);
    EXPECT_NEAR(state.position[2].y, 8 + 0.1 * (first + second), 1e-6);
    EXPECT_NEAR(state.velocity[2].x, 1 / 1.05 / 1.05, 1e-6);
  }
}

TEST(Xpbd, ConvergesToTheOscillatorWithOrderOneInSmallSteps) {
  // The length l - L of the spring obeys m x'' = -k x - c x', m = 1/3 kg.
  constexpr double mass = 1.0 / 3, k = 30, end_s = 0.5;
  for (const double c : {0.0, 0.5, 2.0}) {
    System system = one_spring({k, c});
    const double decay = c / (2 * mass), angular = std::sqrt(k / mass - decay * decay);
    const double exact = 0.5 * std::exp(-decay * end_s) *
                         (std::cos(angular * end_s) + decay / angular * std::sin(angular * end_s));
    std::vector<double> errors;
    for (const std::uint32_t substeps : {200U, 400U, 800U}) {
      system.solver.substeps = substeps;
      const State state = state_after(*make_reference(system, xpbd, end_s / 5), 5);
      errors.push_back(std::abs(state.position[1].x - state.position[0].x - 1 - exact));
    }
    EXPECT_LT(errors.back(), 0.002) << c;
    for (std::size_t i = 1; i < errors.size(); ++i)
      EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), 1, 0.1) << c;
  }
}

TEST(Xpbd, ConvergesWithGrowingSubstepsToWhatRk4Finds) {
  System system = cloth_system(13, 14);
  const auto exact = make_reference(system, *find_integrator("rk4"), 1e-4);
  exact->step(200);
  std::vector<double> errors;
  for (const std::uint32_t substeps : {5U, 10U, 20U, 40U}) {
    system.solver.substeps = substeps;
    errors.push_back(largest_distance(state_after(*make_reference(system, xpbd, 1e-4), 200).position,
                                      exact->state().position));
  }
  for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), 1, 0.2);
}

/// Takes 300 steps of 50 times the explicit limit with what hangs from its first row, and expects that it
/// swings without gaining energy.
void expect_stable(SceneSpec spec) {
  spec.viscous_damping_per_s = 0;
  auto& cloth = std::get<ClothSpec>(spec.content);
  cloth.pins = ClothPins{0, 1};
  for (auto& spring : cloth.springs) spring.stiffness *= 1000;
  System system = build_system(spec);
  system.floor.height = -100;
  const double dt_s = 50 * largest_stable_dt(integrators[0], mode_bound(system));
  const double start = energy_of(system, system.start).total();
  for (const auto& backend : all_backends(system, dt_s))
    for (int round = 0; round < 30; ++round) {
      const State state = state_after(*backend, 10);
      ASSERT_FALSE(first_bad_node(state)) << round;
      EXPECT_LE(energy_of(system, state).total(), start + 1e-6 * std::abs(start)) << round;
    }
}

TEST(Xpbd, KeepsAStiffHangingChainStableFarBeyondTheExplicitLimit) { expect_stable(cloth_spec(40, 1)); }
TEST(Xpbd, KeepsAStiffClothStableFarBeyondTheExplicitLimit) { expect_stable(cloth_spec(21, 19)); }

TEST(Xpbd, KeepsTheMomentumOfALoneCloth) {
  const System system = lone_cloth(23, 18);
  const auto momentum_of = [&](const State& state) {
    Vec3d sum;
    for (std::size_t i = 0; i < system.nodes(); ++i) sum += system.node_mass[i] * state.velocity[i];
    return sum;
  };
  const Vec3d before = momentum_of(system.start);
  for (const auto& backend : all_backends(system, 1e-3)) {
    const State state = state_after(*backend, 50);
    double sizes = 0;
    for (std::size_t i = 0; i < system.nodes(); ++i) sizes += system.node_mass[i] * length(state.velocity[i]);
    EXPECT_LE(length(momentum_of(state) - before), 1e-6 * sizes);
    EXPECT_GT(largest_distance(state.velocity, system.start.velocity), 0.01) << "the nodes move";
  }
}

TEST(Xpbd, MovesNodesThatASmallStepMovesByLessThanARounding) {
  // At 8 m positions in single precision are 1e-6 m apart; a small step moves this node by 1e-7 m.
  System system = one_spring({0, 0});
  system.start.velocity[2] = {0, 0.01, 0};
  for (const auto& backend : all_backends(system, 1e-4))
    EXPECT_NEAR(state_after(*backend, 1000).position[2].y, 8.001, 1e-8);
}

/// Makes a system whose last node falls freely through air, in small steps of 1e-6 s that change its velocity
/// by a tenth of a rounding (damping) and by ten (gravity).
System falling_freely(System system) {
  std::ranges::fill(system.materials, SpringMaterial{});
  system.gravity = 9.81;
  system.viscous_damping = 0.1;
  system.solver.substeps = 100;
  system.start.velocity.back() = {1, -8, 0};
  return system;
}

void expect_free_fall(Backend& backend, const System& system) {
  constexpr int steps = 500;
  backend.step(steps);
  const double kept = std::pow(1 / (1 + backend_dt_s / system.solver.substeps * system.viscous_damping),
                               steps * system.solver.substeps);
  const double end_speed = system.gravity / system.viscous_damping;
  const Vec3d v = backend.state().velocity.back();
  EXPECT_NEAR(v.x, kept, 1e-6);
  EXPECT_NEAR(v.y, -8 * kept - end_speed * (1 - kept), 1e-6);
}

TEST(Xpbd, ChangesVelocitiesByLessThanARounding) {
  const System system = falling_freely(one_spring({}));
  for (const auto& backend : all_backends(system, backend_dt_s)) expect_free_fall(*backend, system);
}

TEST(Xpbd, PutsWhatFallsExactlyOntoTheFloor) {
  // What the sum of y has lost would leave the node beside it.
  System system = one_spring({0, 0});
  system.floor.height = 8;
  system.start.position[2].y = 8.0000123;
  system.start.velocity[2] = {0, -0.37, 0};
  for (const auto& backend : all_backends(system, 1e-4)) EXPECT_EQ(state_after(*backend, 1).position[2].y, 8);
}

TEST(Xpbd, GoesOnFromAStateAsIfNothingHadHappened) {
  const System system = cloth_system(9, 11);
  auto backends = all_backends(system, 1e-4);
  backends.erase(backends.begin());  // what the reference's sums lose does not fit into a state's doubles
  for (const auto& backend : backends) {
    const State middle = state_after(*backend, 30);
    const State end = state_after(*backend, 30);
    backend->set_state(middle);
    EXPECT_TRUE(same_state(state_after(*backend, 30), end));
  }
}

// xpbd in vectors, for every instruction set that this processor has.

/// Single rows and columns, fewer columns than lanes, and whole vectors inside; enough rows for threads.
const std::vector<std::pair<std::uint32_t, std::uint32_t>> cloth_sizes{
    {1, 7}, {7, 1}, {2, 2}, {3, 40}, {40, 3}, {37, 23}, {50, 50}, {66, 131}, {113, 65}};

/// Each large enough to be a part of its own.
System three_blocks(double height_m) { return alike_bodies(solid_block(7, 7, 7, height_m), 3); }

std::vector<System> solids() { return {solid_block(2, 2, 2), solid_block(9, 8, 7), two_solid_blocks()}; }

std::vector<StepKernel<QuarteredRows>> cloth_kernels() { return compiled_kernels<QuarteredRows>(); }

/// The vector code for one instruction set.
class EachXpbdKernel : public testing::TestWithParam<std::size_t> {
 protected:
  static std::unique_ptr<Backend> make(const System& system, int threads, std::size_t kernel) {
    return make_vector_backend<QuarteredRows, SpringBatches>(
        system, backend_dt_s,
        {.threads = threads, .instruction_set = cloth_kernels()[kernel].instruction_set});
  }
  static std::unique_ptr<Backend> make(const System& system, int threads) {
    return make(system, threads, GetParam());
  }
  static void expect_reference(const System& system, const std::string& name) {
    EXPECT_TRUE(agrees(*make(system, 2), system, xpbd, backend_dt_s)) << name;
  }
  /// The same bits at any number of threads, and as the best kernel that rounds alike.
  static void expect_same_bits(const System& system, const std::string& name) {
    const auto kernels = cloth_kernels();
    const auto best = std::ranges::find_if(kernels, [&](const auto& other) {
      return fuses(other.instruction_set) == fuses(kernels[GetParam()].instruction_set) &&
             other.exact_roots == kernels[GetParam()].exact_roots;
    });
    const State expected =
        state_after(*make(system, 1, static_cast<std::size_t>(best - kernels.begin())), 23);
    for (const int threads : {1, 2, 3, 7}) {
      const auto backend = make(system, threads);
      backend->step(11);
      EXPECT_TRUE(same_state(state_after(*backend, 12), expected)) << name << ", " << threads;
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
  expect_reference(three_blocks(0.5), "three blocks");
}

TEST_P(EachXpbdKernel, ChangesVelocitiesByLessThanARounding) {
  for (const System& system : {falling_freely(cloth_system(3, 21)), falling_freely(one_spring({}))})
    expect_free_fall(*make(system, 1), system);
}

TEST_P(EachXpbdKernel, TakesSpringsInTheOrderOfTheMethod) {
  // In steps so long that an impulse makes up for most of what the one before has done to the other springs
  // of a node.
  constexpr double long_s = 0.02;
  for (const auto& [rows, columns] : cloth_sizes) {
    System system = cloth_system(rows, columns);
    system.floor.height = -100;
    const auto reference = make_reference(system, xpbd, long_s);
    const auto backend = make_vector_backend<QuarteredRows, SpringBatches>(
        system, long_s, {.threads = 2, .instruction_set = cloth_kernels()[GetParam()].instruction_set});
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
  expect_same_bits(three_blocks(0.001), "three blocks");
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

TEST_P(EachXpbdKernel, GivesTheSameBitsWhetherThreadsShareBodiesOrNot) {
  const System system = three_blocks(0.001);
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
    for (const std::size_t shared : {0U, 1U, 3U})
      EXPECT_TRUE(same_state(after(threads, shared), expected)) << threads << ", " << shared;
}

TEST_P(EachXpbdKernel, TakesNoMoreThreadsThanBodiesHaveVectors) {
  const StepKernel<SpringBatches> kernel = compiled_kernels<SpringBatches>()[GetParam()];
  const SpringBatches bodies(solid_block(2, 2, 2), backend_dt_s, kernel.lanes, 16);
  EXPECT_EQ(bodies.threads, (8 + kernel.lanes - 1) / kernel.lanes);
}

TEST_P(EachXpbdKernel, TreatsTheFloorLikeTheReference) {
  const System sheet = sliding_sheet(20, 37);
  System block = solid_block(3, 4, 5, 0.02);
  for (Vec3d& v : block.start.velocity) v = {0.5, -4, 0.25};
  for (const System& system : {sheet, block}) {
    const auto reference = make_reference(system, xpbd, backend_dt_s);
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
  System cloth = cloth_system(20, 23, 1, ClothPins{13, 5});
  cloth.floor.height = cloth.start.position[cloth.pins.front()].y + 0.01;
  const System block = pinned(solid_block(4, 5, 6), {0, 17, 118});
  for (const System& system : {cloth, block}) {
    const State state = state_after(*make(system, 3), 51);
    EXPECT_TRUE(pins_hold(system, state));
    EXPECT_NE(state.position[1], system.start.position[1]) << "the others move";
  }
  expect_reference(block, "a block with pins");
}

}  // namespace
}  // namespace mssim
