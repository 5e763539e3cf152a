// What the integrators do, measured on the double-precision reference.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "backends/reference.h"
#include "integrators/all_integrators.h"
#include "tests/support/cloth_system.h"
#include "tests/support/largest_distance.h"

namespace mssim {
namespace {

class EachIntegrator : public testing::TestWithParam<Integrator> {
 protected:
  /// The table's own row: backends tell rows apart by address.
  const Integrator& integrator() const { return *find_integrator(GetParam().name); }
};

INSTANTIATE_TEST_SUITE_P(Table, EachIntegrator, testing::ValuesIn(integrators), [](const auto& test) {
  std::string name(test.param.name);
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
});

State state_after(const System& system, const Integrator& integrator, double dt_s, int steps) {
  const auto backend = make_reference(system, integrator, dt_s);
  backend->step(steps);
  return backend->state();
}

TEST_P(EachIntegrator, ConvergesWithItsOrderOnASmoothProblem) {
  const System system = cloth_system(5, 5);
  const double duration_s = 0.01;
  const State exact = state_after(system, *find_integrator("rk4"), duration_s / 20000, 20000);
  const auto error = [&](int steps) {
    return largest_distance(state_after(system, integrator(), duration_s / steps, steps).position,
                            exact.position);
  };
  const double order = std::log2(error(250) / error(500));
  EXPECT_NEAR(order, integrator().order, 0.15);
}

/// One step of x' = v, v' = -w^2 x as a matrix {xx, xv, vx, vv}, worked out by hand for each method: for
/// Runge-Kutta methods the Taylor polynomial of exp(dt A) up to their order.
std::array<double, 4> recurrence(std::string_view name, double w, double dt) {
  const double q = w * w * dt * dt;
  if (name == "semi-euler") return {1 - q, dt, -w * w * dt, 1};
  if (name == "midpoint") return {1 - q / 2, dt, -w * w * dt, 1 - q / 2};
  if (name == "rk4")
    return {1 - q / 2 + q * q / 24, dt * (1 - q / 6), -w * w * dt * (1 - q / 6), 1 - q / 2 + q * q / 24};
  // Held acceleration: x+ = x + dt v + dt^2/2 a, v+ = v + dt a.
  if (name == "midpoint-frozen" || name == "rk4-frozen") return {1 - q / 2, dt, -w * w * dt, 1};
  return {};
}

TEST_P(EachIntegrator, FollowsItsOwnRecurrenceForAnUndampedOscillator) {
  System system = lone_cloth(1, 2);
  system.pins = {0};
  system.materials = {{200, 0}, {60, 0}, {8, 0}};
  const double rest = static_cast<double>(system.springs.at(0).rest_length);
  system.start.position = {{0, 1, 0}, {1.1 * rest, 1, 0}};
  system.start.velocity = {{}, {0.3, 0, 0}};
  const double w = std::sqrt(200 / system.node_mass[0]), dt = 0.1 / w;
  const auto [xx, xv, vx, vv] = recurrence(integrator().name, w, dt);
  ASSERT_NE(vv, 0) << "no recurrence was worked out for this integrator";

  double x = 0.1 * rest, v = 0.3;
  const auto backend = make_reference(system, integrator(), dt);
  for (int step = 1; step <= 500; ++step) {
    backend->step(1);
    const double x_next = xx * x + xv * v;
    v = vx * x + vv * v;
    x = x_next;
    const State state = backend->state();
    ASSERT_NEAR(state.position[1].x - rest, x, 1e-12) << "step " << step;
    ASSERT_NEAR(state.velocity[1].x / w, v / w, 1e-12) << "step " << step;
    ASSERT_EQ(state.position[1].y, 1);
  }
}

TEST_P(EachIntegrator, LetsAnUnstrainedSheetFallWithoutDeformingIt) {
  SceneSpec spec = sheet_spec(9, 11, 1);
  spec.viscous_damping_per_s = 0;
  const System system = build_system(spec);
  const int steps = 500;
  const double dt = 1e-4, time = steps * dt, g = spec.gravity_m_per_s2;
  // Semi-implicit Euler moves with the speed at each step's end, which adds g t dt / 2.
  const double fall = g * time * time / 2 + (integrator().name == "semi-euler" ? g * time * dt / 2 : 0);
  const State state = state_after(system, integrator(), dt, steps);
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    const Vec3d moved = state.position[i] - system.start.position[i];
    EXPECT_NEAR(moved.y, -fall, 1e-9);
    // Rest lengths are single precision: the sheet starts with strains of 1e-8.
    EXPECT_NEAR(moved.x, 0, 1e-8);
    EXPECT_NEAR(moved.z, 0, 1e-8);
    EXPECT_NEAR(state.velocity[i].y, -g * time, 1e-9);
  }
}

TEST_P(EachIntegrator, KeepsTheMomentumOfALoneCloth) {
  const System system = lone_cloth(9, 11);
  const State end = state_after(system, integrator(), 1e-4, 300);
  Vec3d before{}, after{};
  double moving = 0;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    before += system.start.velocity[i];
    after += end.velocity[i];
    moving += std::sqrt(dot(end.velocity[i], end.velocity[i]));
  }
  EXPECT_GT(largest_distance(system.start.position, end.position), 1e-3)
      << "the cloth must move for this to mean something";
  EXPECT_NEAR(after.x, before.x, 1e-12 * moving);
  EXPECT_NEAR(after.y, before.y, 1e-12 * moving);
  EXPECT_NEAR(after.z, before.z, 1e-12 * moving);
}

TEST(IntegratorTable, NamesEachOnceAndCountsItsStages) {
  for (const Integrator& integrator : integrators) {
    EXPECT_EQ(find_integrator(integrator.name), &integrator);
    for (std::size_t s = 0; s < max_stages; ++s)
      EXPECT_EQ(assignment_count(integrator.stages[s]) > 0, s < integrator.stage_count)
          << integrator.name << " " << s;
    EXPECT_TRUE(writes(integrator.stages[integrator.stage_count - 1], Slot::x_next)) << integrator.name;
    EXPECT_TRUE(writes(integrator.stages[integrator.stage_count - 1], Slot::v_next)) << integrator.name;
  }
  EXPECT_EQ(find_integrator("euler"), nullptr);
}

TEST(IntegratorTable, SharesArraysInPlaceOnlyWhereTheStateIsNoLongerNeeded) {
  EXPECT_EQ(storage_of(*find_integrator("midpoint"), Pair::next, Storage::in_place), Pair::state);
  EXPECT_EQ(storage_of(*find_integrator("rk4"), Pair::next, Storage::in_place), Pair::next);
  EXPECT_EQ(storage_of(*find_integrator("rk4"), Pair::trial_b, Storage::in_place), Pair::trial_a);
  for (const Integrator& integrator : integrators)
    for (const Pair pair : {Pair::state, Pair::next, Pair::trial_a, Pair::trial_b})
      EXPECT_EQ(storage_of(integrator, pair, Storage::separate), pair);
}

}  // namespace
}  // namespace mssim
