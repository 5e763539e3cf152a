// Every method to avoid the data race of the springs against the double-precision reference, for every
// integrator.
#include "backends/accumulation/accumulation_methods.h"

#include <initializer_list>

#include "backends/accumulation/gather_vectors.h"
#include "backends/backends.h"
#include "backends/spring_list/list_backends.h"
#include "backends/vectors/step_kernels.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "tests/support/backend_checks.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

constexpr std::array<int, 3> thread_counts{1, 2, 5};

/// gather-vectors has a layout for cloths alone.
bool steps_bodies(const AccumulationMethod& method) { return method.backend.name != "gather-vectors"; }

class EachWayAndIntegrator : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {
 protected:
  const AccumulationMethod& method() const { return accumulation_methods()[std::get<0>(GetParam())]; }
  const Integrator& integrator() const { return integrators[std::get<1>(GetParam())]; }
  std::unique_ptr<Backend> make(const System& system, int threads) const {
    return method().backend.make(system, integrator(), backend_dt_of(integrator()), {threads, ""});
  }
  State after(const System& system, int threads, int steps) const {
    return state_after(*make(system, threads), steps);
  }
  /// Those that the method steps: a cloth, and bodies where it does not refuse them.
  std::vector<System> steppable(std::initializer_list<System> cloths,
                                std::initializer_list<System> bodies) const {
    std::vector<System> systems(cloths);
    if (steps_bodies(method())) systems.insert(systems.end(), bodies);
    return systems;
  }
};

INSTANTIATE_TEST_SUITE_P(Tables, EachWayAndIntegrator,
                         testing::Combine(testing::Range(std::size_t{0}, accumulation_methods().size()),
                                          testing::Range(std::size_t{0}, integrators.size())),
                         [](const auto& test) {
                           return ByName::of(accumulation_methods()[std::get<0>(test.param)].backend.name,
                                             integrators[std::get<1>(test.param)].name);
                         });

TEST_P(EachWayAndIntegrator, AgreesWithTheReferenceWithAnyNumberOfThreads) {
  for (const System& system : steppable({cloth_system(37, 23)}, {solid_block(4, 5, 6), two_solid_blocks()})) {
    const Reference reference = run_reference(system, integrator(), backend_dt_of(integrator()));
    for (const int threads : thread_counts)
      EXPECT_TRUE(agrees(*make(system, threads), system, reference, backend_dt_of(integrator())))
          << threads << " threads";
  }
}

TEST_P(EachWayAndIntegrator, TakesMoreThreadsThanThereAreNodesOrSprings) {
  const System system = cloth_system(1, 3);
  EXPECT_TRUE(agrees(*make(system, 9), system, integrator(), backend_dt_of(integrator())));
}

TEST_P(EachWayAndIntegrator, GivesTheSameBitsAgainWhereItSaysSo) {
  if (method().repeatable == Repeatable::never) return;
  constexpr int steps = 20;
  for (const System& system : steppable({cloth_system(40, 31)}, {solid_block(5, 6, 7)})) {
    const State alone = after(system, 1, steps);
    for (const int threads : thread_counts) {
      const State once = after(system, threads, steps), again = after(system, threads, steps);
      EXPECT_TRUE(same_state(once, again)) << threads << " threads";
      if (method().repeatable != Repeatable::always) continue;
      EXPECT_TRUE(same_state(once, alone)) << threads << " threads";
    }
  }
}

TEST_P(EachWayAndIntegrator, StartsAgainFromAStateThatItIsGiven) {
  const System system = cloth_system(12, 19);
  expect_starts_again(*make(system, 1), system);  // with one thread every method adds in one order
}

TEST(RaceWays, SayWhichScenesTheyDoNotStep) {
  const System body = solid_block(3, 4, 5);
  for (const AccumulationMethod& method : accumulation_methods()) {
    const auto make = [&] { return method.backend.make(body, integrators[0], backend_dt_s, {1, ""}); };
    if (steps_bodies(method))
      EXPECT_NO_THROW(make()) << method.backend.name;
    else
      EXPECT_THROW(make(), Unsupported) << method.backend.name;
  }
}

TEST(RaceWays, BeginWithTheSerialBaseAndHaveNamesOfTheirOwn) {
  std::set<std::string_view> names;
  for (const AccumulationMethod& method : accumulation_methods())
    EXPECT_TRUE(names.insert(method.backend.name).second) << method.backend.name;
  EXPECT_EQ(accumulation_methods().front().backend.name, "serial");
  EXPECT_EQ(accumulation_methods().back().backend.name, "openmp");
}

// gather-vectors for every instruction set that this processor has, on the cloths where padded rows go wrong.

/// Single rows and columns, fewer columns than lanes, a last vector that is full, has one lane, lacks one or
/// two, and whole rows of vectors inside.
const std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes{
    {50, 50}, {37, 23}, {9, 11}, {3, 40}, {40, 3}, {2, 2},  {1, 7},
    {7, 1},   {2, 1},   {6, 48}, {6, 49}, {6, 47}, {6, 46}, {5, 130}};

/// A cloth whose nodes lie below the level of its pins in a few steps, so that it bounces.
System bouncing_cloth(std::uint32_t rows, std::uint32_t columns) {
  System system = cloth_system(rows, columns);
  system.floor.height = system.start.position[0].y - 0.001;
  return system;
}

class EachRowKernelAndIntegrator : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {
 protected:
  StepKernel<PaddedRows> kernel() const {
    return step_kernels<PaddedRows>(integrator())[std::get<0>(GetParam())];
  }
  const Integrator& integrator() const { return integrators[std::get<1>(GetParam())]; }
  std::unique_ptr<Backend> make(const System& system, int threads) const {
    return make_gather_vectors(system, integrator(), backend_dt_of(integrator()),
                               {.threads = threads, .instruction_set = kernel().instruction_set});
  }
};
INSTANTIATE_TEST_SUITE_P(
    OfThisProcessor, EachRowKernelAndIntegrator,
    testing::Combine(testing::Range(std::size_t{0}, step_kernels<PaddedRows>(integrators[0]).size()),
                     testing::Range(std::size_t{0}, integrators.size())),
    [](const auto& test) {
      return ByName::of(step_kernels<PaddedRows>(integrators[0])[std::get<0>(test.param)].instruction_set,
                        integrators[std::get<1>(test.param)].name);
    });

TEST_P(EachRowKernelAndIntegrator, AgreesWithTheReferenceOnClothsOfAnyShape) {
  for (const auto& [rows, columns] : sizes) {
    const System system = cloth_system(rows, columns);
    EXPECT_TRUE(agrees(*make(system, 2), system, integrator(), backend_dt_of(integrator())))
        << rows << " x " << columns;
  }
}

TEST_P(EachRowKernelAndIntegrator, GivesTheSameBitsForAnyNumberOfThreadsAndAsTheBestThatRoundsAlike) {
  const std::vector<StepKernel<PaddedRows>> kernels = step_kernels<PaddedRows>(integrator());
  const StepKernel<PaddedRows> best =
      *std::ranges::find_if(kernels, [&](const StepKernel<PaddedRows>& other) {
        return fuses(other.instruction_set) == fuses(kernel().instruction_set) &&
               other.exact_roots == kernel().exact_roots;
      });
  constexpr int steps = 101;  // an odd number leaves the state where `next` was
  for (const auto& [rows, columns] : sizes) {
    const System system = bouncing_cloth(rows, columns);
    const State expected =
        state_after(*make_gather_vectors(system, integrator(), backend_dt_of(integrator()),
                                         {.threads = 1, .instruction_set = best.instruction_set}),
                    steps);
    EXPECT_TRUE(rows < 9 || columns < 9 || has_met_floor(system, expected)) << rows << " x " << columns;
    for (const int threads : {1, 2, 3, 7})
      EXPECT_TRUE(same_state(state_after(*make(system, threads), steps), expected))
          << rows << " x " << columns << ", " << threads;
  }
}

TEST_P(EachRowKernelAndIntegrator, TreatsTheFloorLikeTheReference) {
  // Its columns leave lanes without a node, which the floor must not touch.
  const System system = sliding_sheet(20, 37);
  const auto reference = make_reference(system, integrator(), backend_dt_of(integrator()));
  expect_same_bounce(*make(system, 2), *reference, steps_in(integrator(), 0.0015));
}

TEST_P(EachRowKernelAndIntegrator, HoldsPinsExactlyWhereverTheyAreEvenBelowTheFloor) {
  System system = cloth_system(20, 23, 1, ClothPins{13, 5});
  system.floor.height = system.start.position[system.pins.front()].y + 0.01;
  const State state = state_after(*make(system, 3), 51);
  EXPECT_TRUE(pins_hold(system, state));
  EXPECT_NE(state.position[0], system.start.position[0]) << "the others move";
}

TEST_P(EachRowKernelAndIntegrator, LeavesWhatLiesOutsideOfTheClothZero) {
  System system = cloth_system(9, 11);
  system.floor.height = 0.5;  // above the zeros
  PaddedRows cloth(system, std::get<GridPatch>(system.topology), integrator(), backend_dt_of(integrator()),
                   kernel().lanes, 2);
  cloth.set_state(system.start);
  kernel().step(cloth, 21);
  for (AlignedArray& array : cloth.pairs) {
    if (array.size() == 0) continue;
    for (std::size_t row = 0; row < 9; ++row)
      for (std::size_t component = 0; component < PairRows::components; ++component) {
        float* const first = array.data() + cloth.layout.offset(row, 0) + component * cloth.layout.pitch;
        std::fill(first, first + 11, 0.0F);
      }
    EXPECT_EQ(std::count(array.data(), array.data() + array.size(), 0.0F),
              static_cast<std::ptrdiff_t>(array.size()));
  }
}

TEST(GatherVectors, StaysAsNearToTheReferenceAsTheSpringList) {
  const System system = cloth_system(100, 140);
  for (const Integrator& integrator : integrators) {
    const double dt_s = backend_dt_of(integrator);
    expect_as_near_as_the_spring_list(*make_gather_vectors(system, integrator, dt_s, {2, ""}), system,
                                      integrator, dt_s);
  }
}

}  // namespace
}  // namespace mssim
