// implicit-euler and newton-euler with vectors and threads, for every instruction set of this processor.

#include "backends/backends.h"
#include "backends/implicit/newton/step_newton.h"
#include "backends/implicit/nodes/solvers.h"
#include "backends/vectors/step_kernels.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "tests/support/backend_checks.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

std::vector<std::string_view> newton_sets() {
  return instruction_sets_of(compiled_kernels<VectorEquation<NodeRows>>());
}

class EachNewtonKernelAndIntegrator
    : public testing::TestWithParam<std::tuple<std::size_t, std::string_view>> {
 protected:
  const Integrator& integrator() const { return *find_integrator(std::get<1>(GetParam())); }
  std::unique_ptr<Backend> make(const System& system, int threads = 2, double dt_s = backend_dt_s,
                                std::size_t most_kept = most_slope_bytes) const {
    return make_vector_backend<VectorEquation<NodeRows>, VectorEquation<NodeSlices>>(
        system, dt_s,
        {.threads = threads, .instruction_set = std::string(newton_sets()[std::get<0>(GetParam())])},
        integrator(), most_kept);
  }
};
INSTANTIATE_TEST_SUITE_P(OfThisProcessor, EachNewtonKernelAndIntegrator,
                         testing::Combine(testing::Range(std::size_t{0}, newton_sets().size()),
                                          testing::Values("implicit-euler", "newton-euler")),
                         [](const auto& test) {
                           return ByName::of(newton_sets()[std::get<0>(test.param)], std::get<1>(test.param));
                         });

TEST_P(EachNewtonKernelAndIntegrator, AgreesWithTheReferenceOnSystemsOfAnyShape) {
  for (const System& system : odd_systems()) {
    const Reference reference = run_reference(system, integrator(), backend_dt_s);
    for (const std::size_t most_kept : {most_slope_bytes, std::size_t{0}})
      EXPECT_TRUE(agrees(*make(system, 2, backend_dt_s, most_kept), system, reference, backend_dt_s))
          << most_kept << " bytes of slopes";
  }
}

TEST_P(EachNewtonKernelAndIntegrator, AgreesWithTheReferenceWithLongSteps) {
  // Springs, not the inertia of nodes, rule such a step's matrix: conjugate gradients need many iterations.
  constexpr double long_dt_s = 50 * backend_dt_s;
  for (System system : {cloth_system(37, 23), solid_block(5, 4, 7)}) {
    system.solver.tolerance = 1e-6;
    const auto reference = make_reference(system, integrator(), long_dt_s);
    const auto serial = make_serial_newton(system, integrator(), long_dt_s, {});
    const auto simulation = make(system, 2, long_dt_s);
    for (Backend* backend : {reference.get(), serial.get(), simulation.get()}) backend->step(2);
    const std::vector<Vec3d> expected = reference->state().position;
    EXPECT_GT(largest_distance(expected, system.start.position), 0.002) << "it has moved";
    // Steps this long amplify roundings, which bend the cloth. A wrong matrix solves nothing to 1e-6.
    const double usual = largest_distance(serial->state().position, expected);
    EXPECT_GT(usual, 0);
    EXPECT_LE(largest_distance(simulation->state().position, expected), 4 * usual + 1e-7) << system.nodes();
    EXPECT_EQ(simulation->note(), "");
  }
}

TEST_P(EachNewtonKernelAndIntegrator, TakesSpringsThatAreFarStrongerThanInertia) {
  // Blocks of 1e14, whose determinants single precision does not hold.
  for (System system : {pinned(cloth_system(20, 23), {0, 22}), solid_block(5, 4, 7)}) {
    for (SpringMaterial& material : system.materials) material.stiffness *= 1e12;
    const auto simulation = make(system, 2, 1e-2);
    const double before = energy_of(system, system.start).elastic;
    EXPECT_LT(energy_of(system, state_after(*simulation, 1)).elastic, before) << system.nodes();
  }
}

TEST_P(EachNewtonKernelAndIntegrator, GivesTheSameBitsAtEveryNumberOfThreads) {
  for (System& system : odd_systems()) {
    system.floor.height = system.start.position[0].y - 0.001;  // it is met on the way
    const auto steps_of = [&](int threads, std::size_t most_kept) {
      const auto simulation = make(system, threads, 10 * backend_dt_s, most_kept);
      simulation->step(9);
      return state_after(*simulation, 4);
    };
    for (const std::size_t most_kept : {most_slope_bytes, std::size_t{0}}) {
      const State expected = steps_of(1, most_kept);
      for (const int threads : {2, 3, 7})
        EXPECT_TRUE(same_state(steps_of(threads, most_kept), expected))
            << threads << " threads, " << system.nodes() << " nodes";
    }
  }
}

TEST_P(EachNewtonKernelAndIntegrator, StartsAgainFromAStateThatItIsGiven) {
  for (const System& system : {cloth_system(12, 19), solid_block(3, 4, 5)})
    expect_starts_again(*make(system), system);
}

TEST_P(EachNewtonKernelAndIntegrator, HoldsPinsExactlyEvenBelowTheFloor) {
  for (System system : {pinned(cloth_system(20, 23), {0, 40, 247, 300, 459}),
                        pinned(solid_block(5, 4, 7), {0, 7, 63, 64, 139})}) {
    system.floor.height = system.start.position[system.pins.front()].y + 0.001;
    const State state = state_after(*make(system), 20);
    EXPECT_TRUE(pins_hold(system, state));
    EXPECT_NE(state.position[1], system.start.position[1]) << "the others move";
  }
}

TEST_P(EachNewtonKernelAndIntegrator, TreatsTheFloorLikeTheReference) {
  const System system = sliding_sheet(20, 17);
  expect_same_bounce(*make(system), *make_reference(system, integrator(), backend_dt_s), 15);
}

}  // namespace
}  // namespace mssim
