#include "guide/trusted_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/verification/verification.h"
#include "tests/support/cloth_system.h"
#include "tests/support/spring_chain.h"

namespace mssim {
namespace {

bool never() { return false; }

TEST(IndependentSolver, FollowsAnOscillator) {
  const System system = spring_oscillator();
  const double omega = oscillator_frequency(system), span_s = 20.3 / omega;
  const auto state = independent_state(system, span_s, 1e-12, never);
  ASSERT_TRUE(state);
  // The springs' rest lengths are in single precision.
  EXPECT_NEAR(state->position[1].x - 0.01, 1e-4 * std::cos(20.3), 1e-8);
  EXPECT_NEAR(state->velocity[1].x, -1e-4 * omega * std::sin(20.3), 1e-8 * omega);
  EXPECT_EQ(state->position[0], system.start.position[0]);
}

TEST(IndependentSolver, EndsWhereItIsStopped) {
  const System system = spring_oscillator();
  EXPECT_FALSE(independent_state(system, 1, 1e-12, [] { return true; }));
}

TEST(TrustedState, IsConfirmedByAnotherSolver) {
  const System system = cloth_system(9, 9);
  const TrustedState trusted =
      trusted_state(system, {.longest_s = 0.02, .first_dt_s = 1e-4, .seconds = 100, .wanted_error = 1e-7});
  ASSERT_EQ(trusted.failure, "");
  EXPECT_NEAR(trusted.horizon_s, 0.02, 1e-9);
  EXPECT_LE(trusted.own_error, 1e-7);
  ASSERT_TRUE(trusted.confirmed);
  EXPECT_LE(*trusted.confirmed, 2e-7);
  EXPECT_LT(trusted.dt_s, 1e-4);
}

TEST(TrustedState, EndsItsHorizonBeforeTheFloor) {
  // Falls 1 mm in 14 ms.
  const System system = build_system(sheet_spec(4, 4, 0.001));
  const TrustedState trusted = trusted_state(system, {.longest_s = 0.05, .first_dt_s = 1e-4, .seconds = 100});
  EXPECT_GT(trusted.horizon_s, 0.010);
  EXPECT_LT(trusted.horizon_s, 0.0143);
  EXPECT_THAT(trusted.why_there, testing::HasSubstr("floor"));
}

TEST(TrustedState, SaysThatThereIsNoHorizon) {
  const System system = build_system(sheet_spec(4, 4, 1e-6));
  EXPECT_THAT(trusted_state(system, {.longest_s = 1, .first_dt_s = 1e-4, .seconds = 100}).failure,
              testing::HasSubstr("no horizon"));
}

TEST(TrustedState, IsNotBegunWithoutTimeForAStep) {
  const TrustedState trusted =
      trusted_state(cloth_system(9, 9), {.longest_s = 0.02, .first_dt_s = 1e-4, .seconds = 1e-9});
  EXPECT_THAT(trusted.failure, testing::HasSubstr("no time"));
}

TEST(TrustedState, EndsItsHorizonWhereNeighboursPart) {
  // Compressed springs: a node beside the line runs off, faster and faster.
  System system = spring_chain(5);
  for (Spring& spring : system.springs) spring.rest_length = 0.012F;
  const TrustedState trusted = trusted_state(system, {.longest_s = 0.02, .first_dt_s = 1e-5, .seconds = 100});
  ASSERT_EQ(trusted.failure, "");
  EXPECT_LT(trusted.horizon_s, 0.01);
  EXPECT_LE(trusted.parting, allowed_parting);
  EXPECT_THAT(trusted.why_there, testing::HasSubstr("neighbouring trajectories part"));
}

}  // namespace
}  // namespace mssim
