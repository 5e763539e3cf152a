// Every method to avoid the data race of the springs against the double-precision reference, for every
// integrator.
#include "backends/accumulation/accumulation_methods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "bench/verification/verification.h"
#include "integrators/integrators.h"
#include "tests/support/backend_step.h"
#include "tests/support/cloth_system.h"
#include "tests/support/solid_system.h"

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
    const auto simulation = make(system, threads);
    simulation->step(steps);
    return simulation->state();
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
                           std::string name(accumulation_methods()[std::get<0>(test.param)].backend.name);
                           name += "__" + std::string(integrators[std::get<1>(test.param)].name);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST_P(EachWayAndIntegrator, AgreesWithTheReferenceWithAnyNumberOfThreads) {
  for (const System& system : steppable({cloth_system(37, 23)}, {solid_block(4, 5, 6), two_solid_blocks()})) {
    const Reference reference = run_reference(system, integrator(), backend_dt_of(integrator()));
    ASSERT_FALSE(reference.failure) << *reference.failure;
    for (const int threads : thread_counts) {
      const Verification verification =
          verify(*make(system, threads), system, reference, backend_dt_of(integrator()));
      EXPECT_FALSE(verification.failure)
          << system.nodes() << " nodes, " << threads << " threads: " << verification.failure.value_or("");
    }
  }
}

TEST_P(EachWayAndIntegrator, TakesMoreThreadsThanThereAreNodesOrSprings) {
  const System system = cloth_system(1, 3);
  const Reference reference = run_reference(system, integrator(), backend_dt_of(integrator()));
  const Verification verification = verify(*make(system, 9), system, reference, backend_dt_of(integrator()));
  EXPECT_FALSE(verification.failure) << verification.failure.value_or("");
}

TEST_P(EachWayAndIntegrator, GivesTheSameBitsAgainWhereItSaysSo) {
  if (method().repeatable == Repeatable::never) return;
  constexpr int steps = 20;
  for (const System& system : steppable({cloth_system(40, 31)}, {solid_block(5, 6, 7)})) {
    const State alone = after(system, 1, steps);
    for (const int threads : thread_counts) {
      const State once = after(system, threads, steps), again = after(system, threads, steps);
      EXPECT_EQ(once.position, again.position) << threads << " threads";
      EXPECT_EQ(once.velocity, again.velocity) << threads << " threads";
      if (method().repeatable != Repeatable::always) continue;
      EXPECT_EQ(once.position, alone.position) << threads << " threads";
      EXPECT_EQ(once.velocity, alone.velocity) << threads << " threads";
    }
  }
}

TEST_P(EachWayAndIntegrator, StartsAgainFromAStateThatItIsGiven) {
  const System system = cloth_system(12, 19);
  const auto simulation = make(system, 1);  // with one thread every method adds in one order
  simulation->step(7);
  const State once = simulation->state();
  simulation->set_state(system.start);
  EXPECT_EQ(simulation->state().position, system.start.position);
  simulation->step(3);
  simulation->step(4);
  EXPECT_EQ(simulation->state().position, once.position);
  EXPECT_EQ(simulation->state().velocity, once.velocity);
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
  for (const AccumulationMethod& method : accumulation_methods()) {
    EXPECT_TRUE(names.insert(method.backend.name).second) << method.backend.name;
    EXPECT_FALSE(method.extra_memory.empty() || method.springs_computed.empty() ||
                 method.backend.description.empty());
    EXPECT_FALSE(name_of(method.repeatable).empty());
  }
  EXPECT_EQ(accumulation_methods().front().backend.name, "serial");
  EXPECT_EQ(accumulation_methods().back().backend.name, "openmp");
}

}  // namespace
}  // namespace mssim
