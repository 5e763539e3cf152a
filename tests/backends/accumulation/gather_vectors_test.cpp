// gather-vectors for every instruction set that this processor has, on the cloths where padded rows go wrong.
#include "backends/accumulation/gather_vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "backends/backends.h"
#include "backends/spring_list/list_backends.h"
#include "bench/verification/verification.h"
#include "integrators/integrators.h"
#include "tests/support/backend_step.h"
#include "tests/support/cloth_system.h"
#include "tests/support/fused_sets.h"

namespace mssim {
namespace {

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
    return make_gather_vectors(system, integrator(), backend_dt_of(integrator()), {threads, ""}, kernel());
  }
};
INSTANTIATE_TEST_SUITE_P(
    OfThisProcessor, EachRowKernelAndIntegrator,
    testing::Combine(testing::Range(std::size_t{0}, step_kernels<PaddedRows>(integrators[0]).size()),
                     testing::Range(std::size_t{0}, integrators.size())),
    [](const auto& test) {
      std::string name = step_kernels<PaddedRows>(integrators[0])[std::get<0>(test.param)].instruction_set;
      name += "__" + std::string(integrators[std::get<1>(test.param)].name);
      std::ranges::replace(name, '-', '_');
      return name;
    });

TEST_P(EachRowKernelAndIntegrator, AgreesWithTheReferenceOnClothsOfAnyShape) {
  for (const auto& [rows, columns] : sizes) {
    const System system = cloth_system(rows, columns);
    const Reference reference = run_reference(system, integrator(), backend_dt_of(integrator()));
    ASSERT_EQ(reference.steps, verification_steps);
    const Verification verification =
        verify(*make(system, 2), system, reference, backend_dt_of(integrator()));
    EXPECT_FALSE(verification.failure)
        << rows << " x " << columns << ": " << verification.failure.value_or("");
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
    const auto alone = make_gather_vectors(system, integrator(), backend_dt_of(integrator()), {1, ""}, best);
    alone->step(steps);
    const State expected = alone->state();
    EXPECT_TRUE(rows < 9 || columns < 9 || has_met_floor(system, expected)) << rows << " x " << columns;
    for (const int threads : {1, 2, 3, 7}) {
      const auto simulation = make(system, threads);
      simulation->step(steps);
      const State state = simulation->state();
      EXPECT_EQ(state.position, expected.position) << rows << " x " << columns << ", " << threads;
      EXPECT_EQ(state.velocity, expected.velocity) << rows << " x " << columns << ", " << threads;
    }
  }
}

TEST_P(EachRowKernelAndIntegrator, TreatsTheFloorLikeTheReference) {
  // A sheet that hits the floor flat, sliding: its nodes land in the same step in any precision. Its columns
  // leave lanes without a node, which the floor must not touch.
  System system = build_system(sheet_spec(20, 37, 0.00101));
  for (Vec3d& v : system.start.velocity) v = {0.5, -1, 0.25};
  const auto reference = make_reference(system, integrator(), backend_dt_of(integrator()));
  const auto simulation = make(system, 2);
  const int steps = steps_in(integrator(), 0.0015);
  reference->step(steps);
  simulation->step(steps);
  const State expected = reference->state(), state = simulation->state();
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    EXPECT_GT(expected.velocity[i].y, 0.2) << "it has bounced";
    EXPECT_LT(expected.velocity[i].x, 0.45) << "friction has slowed it";
    EXPECT_NEAR(state.velocity[i].x, expected.velocity[i].x, 2e-3);
    EXPECT_NEAR(state.velocity[i].y, expected.velocity[i].y, 2e-3);
    EXPECT_NEAR(state.velocity[i].z, expected.velocity[i].z, 2e-3);
    EXPECT_NEAR(state.position[i].y, expected.position[i].y, 1e-6);
  }
}

TEST_P(EachRowKernelAndIntegrator, HoldsPinsExactlyWhereverTheyAreEvenBelowTheFloor) {
  SceneSpec spec = cloth_spec(20, 23);
  std::get<ClothSpec>(spec.content).pins = ClothPins{13, 5};
  System system = build_system(spec);
  system.floor.height = system.start.position[system.pins.front()].y + 0.01;
  const auto simulation = make(system, 3);
  simulation->step(51);
  const State state = simulation->state();
  for (const std::uint32_t node : system.pins) {
    EXPECT_EQ(state.position[node], system.start.position[node]) << node;
    EXPECT_EQ(state.velocity[node], Vec3d{}) << node;
  }
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
  for (const Integrator& integrator : integrators) {
    const System system = cloth_system(100, 140);
    const double dt_s = backend_dt_of(integrator);
    const Reference reference = run_reference(system, integrator, dt_s);
    const auto distance = [&](Backend& backend) {
      return verify(backend, system, reference, dt_s).position_error;
    };
    const double usual = distance(*make_serial(system, integrator, dt_s, {1, ""}));
    EXPECT_GT(usual, 0);
    EXPECT_LE(distance(*make_gather_vectors(system, integrator, dt_s, {2, ""})), 2 * usual)
        << integrator.name;
  }
}

TEST(GatherVectors, TakesTheBestInstructionSetThatHasTheRoots) {
  const System system = cloth_system(9, 11);
  const std::vector<StepKernel<PaddedRows>> kernels = step_kernels<PaddedRows>(integrators[0]);
  const auto device = [&](Roots roots) {
    return make_gather_vectors(system, integrators[0], backend_dt_s, {.threads = 1, .roots = roots})
        ->device();
  };
  EXPECT_EQ(device(Roots::fast), std::string("cpu ") + kernels.front().instruction_set);
  EXPECT_EQ(device(Roots::exact),
            std::string("cpu ") +
                std::ranges::find_if(kernels, &StepKernel<PaddedRows>::exact_roots)->instruction_set);
}

TEST(GatherVectors, BeginsEachComponentOfARowWithAVector) {
  for (const StepKernel<PaddedRows>& kernel : step_kernels<PaddedRows>(integrators[0]))
    for (const auto& [rows, columns] : sizes) {
      const PairRows layout(GridPatch{rows, columns, 0.01}, kernel.lanes);
      EXPECT_EQ(layout.offset(0, 0) % kernel.lanes, 0U);
      EXPECT_EQ(layout.pitch / kernel.lanes % 2, 1U) << "vectors of a row's component";
      EXPECT_GE(layout.margin, PairRows::ring);
      EXPECT_GE(layout.pitch, layout.margin + columns);
    }
}

}  // namespace
}  // namespace mssim
