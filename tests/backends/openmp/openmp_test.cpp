#include "backends/openmp/openmp.h"

#include <omp.h>
#include <sys/resource.h>

#include "backends/openmp/bodies.h"
#include "backends/spring_list/list_backends.h"
#include "backends/vectors/step_kernels.h"
#include "integrators/all_integrators.h"
#include "tests/support/backend_checks.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// Bodies low enough to meet the floor within the steps: of a kind more and fewer than lanes, some with pins,
/// one alone, and nodes that no spring joins.
System many_bodies() {
  System system = alike_bodies(solid_block(4, 4, 5, 0.002), 19);
  System pinned = solid_block(3, 3, 4, 0.002);
  pinned.pins = {0, 17};
  for (const std::uint32_t node : pinned.pins) pinned.start.velocity[node] = {};
  append_body(system, alike_bodies(pinned, 3), {0, 0, 1});
  append_body(system, solid_block(5, 5, 5, 0.002), {0, 0, 2});
  for (int i = 0; i < 3; ++i) {
    system.start.add({0, 0.01 + 0.001 * i, 3}, {0, -1, 0});
    system.node_mass.push_back(0.004);
  }
  round_to_single(system.start);
  return system;
}

class BodiesAbreast : public testing::TestWithParam<std::string_view> {};
INSTANTIATE_TEST_SUITE_P(Integrators, BodiesAbreast,
                         testing::Values("semi-euler", "midpoint", "rk4", "rk4-frozen", "explicit-euler"),
                         ByName());

// What a body's node feels, and in which order that is added, does not depend on how bodies lie in memory.
TEST_P(BodiesAbreast, TakesTheStepsOfSlicesToTheLastBitForAnyThreadsAndInstructionSet) {
  const Integrator& method = *find_integrator(GetParam());
  const System system = many_bodies();
  const auto alike = find_alike_bodies(system);
  ASSERT_TRUE(alike);
  const double dt_s = backend_dt_of(method);
  for (const StepKernel<BodyLanes>& kernel : step_kernels<BodyLanes>(method)) {
    std::size_t found = 0;
    for (const StepKernel<SlicedBodies>& other : step_kernels<SlicedBodies>(method)) {
      if (std::string_view(other.instruction_set) != kernel.instruction_set) continue;
      ++found;
      SlicedBodies slices(system, method, dt_s, other.lanes, 2);
      slices.set_state(system.start);
      other.step(slices, 60);
      const State expected = slices.state();
      ASSERT_NE(expected.position, system.start.position);
      for (const std::size_t threads : {1U, 2U, 3U, 7U, 64U}) {
        BodyLanes bodies(system, *alike, method, dt_s, kernel.lanes, threads);
        bodies.set_state(system.start);
        EXPECT_TRUE(same_state(bodies.state(), system.start));
        kernel.step(bodies, 0);
        kernel.step(bodies, 31);  // an odd number: the pairs have changed places
        kernel.step(bodies, 29);
        EXPECT_TRUE(same_state(bodies.state(), expected)) << kernel.instruction_set << ", " << threads;
      }
    }
    EXPECT_EQ(found, 1U);
  }
}

// With AVX-512 that is AVX2 for six to eight bodies; where the best vectors are those of AVX2, nothing is
// narrower.
TEST(BodyLanes, HaveTheNarrowestVectorsOfWhichNoMoreAreNeeded) {
  const Integrator& method = *find_integrator("semi-euler");
  const std::vector<StepKernel<BodyLanes>> kernels = step_kernels<BodyLanes>(method);
  const StepKernel<BodyLanes>& best = kernels.front();
  for (const std::size_t count : {6U, 7U, 8U, 9U, 13U, 16U, 17U}) {
    const System system = alike_bodies(solid_block(4, 4, 5, 0.002), count);
    const StepKernel<BodyLanes>* expected = &best;
    for (const StepKernel<BodyLanes>& kernel : kernels)
      if (kernel.lanes < expected->lanes && kernel.fuses == best.fuses &&
          (count + kernel.lanes - 1) / kernel.lanes == (count + best.lanes - 1) / best.lanes)
        expected = &kernel;
    const auto backend = make_openmp(system, method, 1e-4, {1, ""});
    EXPECT_EQ(backend->device(), std::string("cpu ") + expected->instruction_set) << count;
    EXPECT_TRUE(agrees(*backend, system, method, 1e-4)) << count;
    const auto named =
        make_openmp(system, method, 1e-4, {.threads = 1, .instruction_set = best.instruction_set});
    EXPECT_EQ(named->device(), std::string("cpu ") + best.instruction_set) << count;
  }
}

TEST(BodyLanes, AreCutIntoFairShares) {
  const System system = alike_bodies(solid_block(9, 9, 9), 16);
  const BodyLanes bodies(system, *find_alike_bodies(system), integrators[0], 1e-4, 16, 3);
  ASSERT_EQ(bodies.pieces.size(), 3U);
  ASSERT_EQ(bodies.chunks.size(), 3U);
  const AlikeBodies& shape = bodies.shapes.front();
  std::vector<double> springs;
  for (const BodyLanes::Piece& piece : bodies.pieces)
    springs.push_back(static_cast<double>(shape.first_spring[piece.end] - shape.first_spring[piece.begin] +
                                          piece.cut.size()));
  for (const double share : springs) EXPECT_NEAR(share / springs.front(), 1, 0.1);
  EXPECT_TRUE(bodies.pieces.front().cut.empty());
}

// Vectors also hold places that no node of a cloth has, and springs that do not exist reach them.
void expect_openmp_near_serial(const System& system) {
  const Integrator& euler = *find_integrator("semi-euler");
  const State expected = state_after(*make_serial(system, euler, backend_dt_s, {1, ""}), 50);
  for (const std::string_view set : openmp_instruction_sets()) {
    const auto openmp =
        make_openmp(system, euler, backend_dt_s, {.threads = 2, .instruction_set = std::string(set)});
    const State state = state_after(*openmp, 50);
    for (std::size_t i = 0; i < state.position.size(); ++i)
      ASSERT_LT(length(state.position[i] - expected.position[i]), 1e-6) << set << ", node " << i;
  }
}

/// Pages that the second of two threads was the first to touch while `work` ran.
template <class Work>
long pages_of_the_second_thread(Work work) {
  const auto pages = [] {
    long touched = 0;
#pragma omp parallel num_threads(2)
    if (omp_get_thread_num() == 1) {
      rusage usage{};
      getrusage(RUSAGE_THREAD, &usage);
      touched = usage.ru_minflt;
    }
    return touched;
  };
  pages();  // what the thread itself takes
  const long before = pages();
  work();
  return pages() - before;
}

// So large that a pair has several pages where they are huge, too.
TEST(Bodies, AreFirstTouchedByTheThreadThatStepsThem) {
  const Integrator& euler = *find_integrator("semi-euler");
  const System one = solid_block(40, 40, 64);
  EXPECT_GT(pages_of_the_second_thread([&] { SlicedBodies bodies(one, euler, backend_dt_s, 16, 2); }), 0);
  const System many = alike_bodies(solid_block(12, 12, 14), 64);
  const auto alike = find_alike_bodies(many);
  ASSERT_TRUE(alike);
  EXPECT_GT(pages_of_the_second_thread([&] { BodyLanes bodies(many, *alike, euler, backend_dt_s, 16, 2); }),
            0);
}

TEST(OpenMpOnASheetThroughTheOrigin, KeepsWhatIsNotThereFromTheNodes) {
  // Nodes whose coordinates are zero or like each other's, beside places that no node has.
  SceneSpec spec = sheet_spec(37, 23, 0);
  spec.floor.height = -1;
  expect_openmp_near_serial(build_system(spec));
}

TEST(OpenMpOnAClothWithoutAFloor, KeepsWhatIsNotThereFromTheNodes) {
  System system = without_floor(cloth_system(37, 23));
  round_start_to_single(system);
  expect_openmp_near_serial(system);
}

}  // namespace
}  // namespace mssim
