// fast-springs: what it converges to, on the spring list and with vectors.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "backends/implicit/local_global/step_local_global.h"
#include "backends/implicit/nodes/solvers.h"
#include "backends/vectors/step_kernels.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "integrators/stability.h"
#include "model/energy.h"
#include "tests/support/backward_euler.h"
#include "tests/support/cloth_system.h"
#include "tests/support/largest_distance.h"
#include "tests/support/solid_system.h"

namespace mssim {
namespace {

const Integrator& fast_springs = *find_integrator("fast-springs");

System pinned_block() {
  System system = solid_block(4, 3, 5);
  system.pins = {0, 7, 30};
  for (const std::uint32_t pin : system.pins) system.start.velocity[pin] = {};
  return system;
}

System with_iterations(System system, std::uint32_t iterations) {
  system.solver.iterations = iterations;
  return system;
}

std::unique_ptr<Backend> make_vectors(const System& system, double dt_s, int threads) {
  return make_openmp_local_global(system, dt_s, {threads, ""});
}

/// Largest distance that a node has come from the start.
double motion_of(const System& system, const State& state) {
  return largest_distance(state.position, system.start.position);
}

TEST(FastSprings, ConvergesToBackwardEuler) {
  for (const double dt_s : {1e-4, 1e-3}) {
    for (const System& system :
         {with_iterations(cloth_system(7, 9), 4000), with_iterations(pinned_block(), 4000)}) {
      const auto local_global = make_local_global_reference(system, dt_s);
      const auto newton = make_newton_reference(system, *find_integrator("newton-euler"), dt_s);
      local_global->step(5);
      newton->step(5);
      const State expected = newton->state();
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
    const auto local_global = make_local_global_reference(limited, dt_s);
    local_global->step(1);
    const double residual = residual_of(system, system.start, local_global->state(), dt_s);
    EXPECT_LT(residual, before) << iterations;
    before = residual;
  }
}

TEST(FastSprings, IsStableAtFiftyTimesTheExplicitLimit) {
  for (const System& system : {cloth_system(20, 17), pinned_block()}) {
    const StiffnessBound bound = stiffness_bound(system);
    const double dt_s =
        50 * largest_stable_dt(integrators[0], {bound.stiffness, bound.damping, system.viscous_damping});
    const double scale = 1e-9 + energy_of(system, system.start).total();
    for (const auto& simulation : {make_local_global_reference(system, dt_s),
                                   make_serial_local_global(system, dt_s), make_vectors(system, dt_s, 2)}) {
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
    for (const auto& simulation : {make_local_global_reference(system, 1e-3),
                                   make_serial_local_global(system, 1e-3), make_vectors(system, 1e-3, 2)}) {
      simulation->step(30);
      const State state = simulation->state();
      for (const std::uint32_t pin : system.pins) {
        EXPECT_EQ(state.position[pin], system.start.position[pin]) << pin;
        EXPECT_EQ(state.velocity[pin], Vec3d{}) << pin;
      }
    }
}

TEST(FastSprings, GivesTheSameBitsAtEveryNumberOfThreads) {
  for (const System& system : {cloth_system(41, 67), two_solid_blocks(), solid_block(9, 9, 9)}) {
    const auto alone = make_vectors(system, 5e-4, 1);
    alone->step(10);
    const State expected = alone->state();
    for (const int threads : {2, 3, 7}) {
      const auto together = make_vectors(system, 5e-4, threads);
      together->step(10);
      EXPECT_EQ(together->threads(), threads);
      EXPECT_EQ(together->state().position, expected.position) << threads;
      EXPECT_EQ(together->state().velocity, expected.velocity) << threads;
    }
  }
}

TEST(FastSprings, TakeFewerThreadsWhereOpenMpGivesFewer) {
  for (const System& system : {cloth_system(41, 67), solid_block(9, 9, 9)}) {
    const auto alone = make_vectors(system, 5e-4, 1), asks_for_three = make_vectors(system, 5e-4, 3);
    alone->step(10);
    // A region within another one gets one thread.
#pragma omp parallel num_threads(2)
#pragma omp single
    asks_for_three->step(10);
    EXPECT_EQ(asks_for_three->state().position, alone->state().position);
    EXPECT_EQ(asks_for_three->state().velocity, alone->state().velocity);
  }
}

/// Odd sizes, fewer rows than lanes, single rows and columns, blocks: where layouts go wrong.
std::vector<System> odd_systems() {
  std::vector<System> systems{pinned_block(), two_solid_blocks(), solid_block(1, 1, 2), solid_block(9, 8, 7)};
  for (const auto& [rows, columns] :
       {std::pair{50U, 50U}, {37U, 23U}, {9U, 11U}, {3U, 40U}, {40U, 3U}, {2U, 2U}, {1U, 7U}, {7U, 1U}})
    systems.push_back(cloth_system(rows, columns));
  return systems;
}

TEST(FastSprings, FollowsTheReferenceInSinglePrecision) {
  constexpr double dt_s = 1e-4;
  for (const System& system : odd_systems()) {
    const Reference reference = run_reference(system, fast_springs, dt_s);
    ASSERT_FALSE(reference.failure) << *reference.failure;
    const auto serial = make_serial_local_global(system, dt_s), vectors = make_vectors(system, dt_s, 2);
    for (Backend* simulation : {serial.get(), vectors.get()}) {
      const Verification verification = verify(*simulation, system, reference, dt_s);
      EXPECT_FALSE(verification.failure) << system.nodes() << ": " << verification.failure.value_or("");
    }
  }
}

TEST(FastSprings, DoesTheSameWithEachInstructionSet) {
  constexpr double dt_s = 1e-3;
  for (const System& system : odd_systems()) {
    const auto reference = make_local_global_reference(system, dt_s);
    reference->step(10);
    const State expected = reference->state();
    for (const std::string_view set : instruction_sets_of(compiled_kernels<LocalGlobalNodes<NodeRows>>())) {
      const auto vectors =
          make_vector_backend<LocalGlobalNodes<NodeRows>, LocalGlobalNodes<NodeSlices>>(system, dt_s, 2, set);
      vectors->step(10);
      EXPECT_EQ(vectors->device(), "cpu " + std::string(set));
      EXPECT_LT(largest_distance(vectors->state().position, expected.position),
                1e-5 * motion_of(system, expected) + 1e-6)
          << set << ", " << system.nodes() << " nodes";
    }
  }
}

TEST(FastSprings, TreatsTheFloorLikeTheReference) {
  System system = build_system(sheet_spec(20, 17, 0.00101));
  for (Vec3d& v : system.start.velocity) v = {0.5, -1, 0.25};
  const auto reference = make_local_global_reference(system, 1e-4), vectors = make_vectors(system, 1e-4, 2);
  reference->step(15);
  vectors->step(15);
  const State expected = reference->state(), state = vectors->state();
  for (std::size_t i = 0; i < system.nodes(); ++i) EXPECT_GT(expected.velocity[i].y, 0.2) << "it has bounced";
  EXPECT_LT(largest_distance(state.position, expected.position), 1e-6);
  EXPECT_LT(largest_distance(state.velocity, expected.velocity), 2e-3);
}

}  // namespace
}  // namespace mssim
