// fast-springs: what it converges to, on the spring list and with vectors.

#include "backends/implicit/local_global/factor.h"
#include "backends/implicit/local_global/step_local_global.h"
#include "backends/implicit/nodes/solvers.h"
#include "backends/interface/backend.h"
#include "backends/vectors/step_kernels.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "integrators/stability.h"
#include "model/system.h"
#include "tests/support/backend_checks.h"
#include "tests/support/backward_euler.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

const Integrator& fast_springs = *find_integrator("fast-springs");

System pinned_block() { return pinned(solid_block(4, 3, 5), {0, 7, 30}); }

System with_iterations(System system, std::uint32_t iterations) {
  system.solver.iterations = iterations;
  return system;
}

std::unique_ptr<Backend> make_vectors(const System& system, double dt_s, int threads) {
  return make_openmp_local_global(system, fast_springs, dt_s, {threads, ""});
}

/// Largest distance that a node has come from the start.
double motion_of(const System& system, const State& state) {
  return largest_distance(state.position, system.start.position);
}

TEST(FastSprings, ConvergesToBackwardEuler) {
  for (const double dt_s : {1e-4, 1e-3}) {
    for (const System& system :
         {with_iterations(cloth_system(7, 9), 4000), with_iterations(pinned_block(), 4000)}) {
      const auto local_global = make_reference(system, fast_springs, dt_s);
      const auto newton = make_reference(system, *find_integrator("newton-euler"), dt_s);
      local_global->step(5);
      const State expected = state_after(*newton, 5);
      EXPECT_LT(largest_distance(local_global->state().position, expected.position),
                1e-8 * motion_of(system, expected))
          << system.nodes() << " nodes, dt " << dt_s;
    }
  }
}

TEST(FastSprings, ComesNearerToBackwardEulerWithEveryIteration) {
  const double dt_s = 2e-3;
  const System system = cloth_system(15, 12);
  double before = HUGE_VAL;
  for (std::uint32_t iterations = 1; iterations <= 12; ++iterations) {
    const System limited = with_iterations(system, iterations);
    const double residual =
        residual_of(system, system.start, state_after(*make_reference(limited, fast_springs, dt_s), 1), dt_s);
    EXPECT_LT(residual, before) << iterations;
    before = residual;
  }
}

TEST(FastSprings, IsStableAtFiftyTimesTheExplicitLimit) {
  for (const System& system : {cloth_system(20, 17), pinned_block()}) {
    const double dt_s = 50 * largest_stable_dt(integrators[0], mode_bound(system));
    const double scale = 1e-9 + energy_of(system, system.start).total();
    for (const auto& simulation :
         {make_reference(system, fast_springs, dt_s),
          make_serial_local_global(system, fast_springs, dt_s, {}), make_vectors(system, dt_s, 2)}) {
      double last = scale;
      for (int step = 0; step < 300; step += 50) {
        simulation->step(50);
        last = energy_of(system, simulation->state()).total();
        EXPECT_LT(last, scale) << system.nodes() << " nodes, step " << step;
      }
      EXPECT_TRUE(std::isfinite(last));
    }
  }
}

TEST(FastSprings, HoldsPinsExactly) {
  for (const System& system : {cloth_system(20, 23), pinned_block()})
    for (const auto& simulation :
         {make_reference(system, fast_springs, 1e-3),
          make_serial_local_global(system, fast_springs, 1e-3, {}), make_vectors(system, 1e-3, 2)})
      EXPECT_TRUE(pins_hold(system, state_after(*simulation, 30)));
}

TEST(FastSprings, GivesTheSameBitsAtEveryNumberOfThreads) {
  for (const System& system : {cloth_system(41, 67), two_solid_blocks(), solid_block(9, 9, 9)}) {
    const State expected = state_after(*make_vectors(system, 5e-4, 1), 10);
    for (const int threads : {2, 3, 7}) {
      const auto together = make_vectors(system, 5e-4, threads);
      together->step(10);
      EXPECT_EQ(together->threads(), threads);
      EXPECT_TRUE(same_state(together->state(), expected)) << threads;
    }
  }
}

TEST(FastSprings, TakesNoMoreThreadsThanAClothHasRows) {
  EXPECT_EQ(make_vectors(cloth_system(2, 40), 5e-4, 16)->threads(), 2);
}

TEST(FastSprings, TakeFewerThreadsWhereOpenMpGivesFewer) {
  for (const System& system : {cloth_system(41, 67), solid_block(9, 9, 9)}) {
    const auto alone = make_vectors(system, 5e-4, 1), asks_for_three = make_vectors(system, 5e-4, 3);
    alone->step(10);
    // A region within another one gets one thread.
#pragma omp parallel num_threads(2)
#pragma omp single
    asks_for_three->step(10);
    EXPECT_TRUE(same_state(asks_for_three->state(), alone->state()));
  }
}

std::vector<System> systems_to_follow() {
  std::vector<System> systems = odd_systems();
  systems.push_back(pinned_block());
  systems.push_back(solid_block(1, 1, 2));
  return systems;
}

TEST(FastSprings, FollowsTheReferenceInSinglePrecision) {
  constexpr double dt_s = 1e-4;
  for (const System& system : systems_to_follow()) {
    const Reference reference = run_reference(system, fast_springs, dt_s);
    EXPECT_TRUE(agrees(*make_serial_local_global(system, fast_springs, dt_s, {}), system, reference, dt_s));
    EXPECT_TRUE(agrees(*make_vectors(system, dt_s, 2), system, reference, dt_s));
  }
}

TEST(FastSprings, DoesTheSameWithEachInstructionSet) {
  constexpr double dt_s = 1e-3;
  for (const System& system : systems_to_follow()) {
    const State expected = state_after(*make_reference(system, fast_springs, dt_s), 10);
    for (const std::string_view set : instruction_sets_of(compiled_kernels<LocalGlobalNodes<NodeRows>>())) {
      const auto vectors = make_vector_backend<LocalGlobalNodes<NodeRows>, LocalGlobalNodes<NodeSlices>>(
          system, dt_s, {.threads = 2, .instruction_set = std::string(set)});
      vectors->step(10);
      EXPECT_EQ(vectors->device(), "cpu " + std::string(set));
      EXPECT_LT(largest_distance(vectors->state().position, expected.position),
                1e-5 * motion_of(system, expected) + 1e-6)
          << set << ", " << system.nodes() << " nodes";
    }
  }
}

TEST(FastSprings, TreatsTheFloorLikeTheReference) {
  const System system = sliding_sheet(20, 17);
  expect_same_bounce(*make_vectors(system, 1e-4, 2), *make_reference(system, fast_springs, 1e-4), 15);
}

// The factors of fast-springs' matrix against the matrix itself.

using DenseMatrix = std::vector<std::vector<double>>;

DenseMatrix dense(const StepMatrix& matrix) {
  DenseMatrix all(matrix.rows(), std::vector<double>(matrix.rows()));
  for (std::size_t i = 0; i < matrix.rows(); ++i) all[i][i] = matrix.diagonal[i];
  for (const auto& [first, second, weight] : matrix.couplings) {
    all[first][second] -= weight;
    all[second][first] -= weight;
  }
  return all;
}

TEST(StepMatrix, HasTheMassesOfFreeNodesAndTheirSprings) {
  const double dt_s = 1e-3;
  const System system = cloth_system(4, 5);
  const StepMatrix matrix(system, dt_s);
  ASSERT_EQ(matrix.rows(), system.nodes() - system.pins.size());
  // A displacement of all free nodes stretches the springs to pins alone.
  double sum = 0, expected = 0;
  for (const auto& row : dense(matrix)) sum += std::accumulate(row.begin(), row.end(), 0.0);
  std::vector<bool> pinned(system.nodes());
  for (const std::uint32_t pin : system.pins) pinned[pin] = true;
  for (std::size_t i = 0; i < system.nodes(); ++i)
    if (!pinned[i]) expected += (1 + dt_s * system.viscous_damping) * system.node_mass[i];
  for (const Spring& spring : system.springs)
    if (pinned[spring.first] != pinned[spring.second])
      expected += dt_s * dt_s * system.materials[spring.kind].stiffness +
                  dt_s * system.materials[spring.kind].damping;
  EXPECT_NEAR(sum, expected, 1e-12 * expected);
}

TEST(Factorise, GivesTheMatrixBack) {
  for (const System& system : {cloth_system(9, 7), two_solid_blocks()}) {
    const StepMatrix matrix(system, 1e-2);
    const ColumnFactor factor = factorise(matrix);
    const std::size_t rows = matrix.rows();
    DenseMatrix product(rows, std::vector<double>(rows));
    for (std::size_t column = 0; column < rows; ++column) {
      EXPECT_EQ(factor.place[factor.first[column]], column);
      for (std::size_t i = factor.first[column]; i < factor.first[column + 1]; ++i)
        for (std::size_t j = factor.first[column]; j < factor.first[column + 1]; ++j)
          product[factor.order[factor.place[i]]][factor.order[factor.place[j]]] +=
              factor.value[i] * factor.value[j];
    }
    const DenseMatrix expected = dense(matrix);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < rows; ++j)
        EXPECT_NEAR(product[i][j], expected[i][j], 1e-13 * expected[i][i]) << i << " " << j;
  }
}

TEST(Factorise, RefusesAMatrixThatIsNotPositiveDefinite) {
  StepMatrix matrix(cloth_system(5, 5), 1e-3);
  matrix.diagonal[7] = -1;
  EXPECT_THROW(factorise(matrix), Unsupported);
  EXPECT_THROW(BlockFactor(matrix, std::vector<Vec3d>(matrix.rows()), 8), Unsupported);
}

TEST(Factorise, RefusesWhatMemoryCannotHold) {
  EXPECT_THAT(sentence_of<Unsupported>([] { require_factor_memory(std::size_t{1} << 50, 8); }),
              StartsWith("the factor of its global step needs at least "));
}

}  // namespace
}  // namespace mssim
