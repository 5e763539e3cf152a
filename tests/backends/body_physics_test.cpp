// What every backend must make of a tetrahedral body: laws of mechanics that need no reference.

#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "tests/support/backend_checks.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

constexpr double body_dt_s = 5e-5;

/// A block whose springs are at rest, and which is at rest itself.
System relaxed_block(double height_m) {
  System system = relaxed(solid_block(3, 3, 3, height_m));
  system.start.velocity.assign(system.nodes(), Vec3d{});
  return system;
}

/// A block that lies on the floor: let down with much damping.
System resting_block() {
  System system = relaxed_block(0.0005);
  System damped = system;
  damped.viscous_damping = 20;
  damped.floor.restitution = 0;
  const auto backend = make_reference(damped, *find_integrator("midpoint"), body_dt_s);
  backend->step(40000);
  system.start.position = backend->state().position;
  round_to_single(system.start);
  return system;
}

struct Momenta {
  double mass = 0;
  Vec3d centre{};   // m
  Vec3d linear{};   // kg m/s
  Vec3d angular{};  // kg m^2/s, around the centre
};

Momenta momenta_of(const System& system, const State& state) {
  Momenta sum;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    sum.mass += system.node_mass[i];
    sum.centre += system.node_mass[i] * state.position[i];
    sum.linear += system.node_mass[i] * state.velocity[i];
  }
  sum.centre = 1 / sum.mass * sum.centre;
  for (std::size_t i = 0; i < system.nodes(); ++i)
    sum.angular += system.node_mass[i] * cross(state.position[i] - sum.centre, state.velocity[i]);
  return sum;
}

constexpr std::array<std::string_view, 3> integrator_names{"semi-euler", "midpoint", "rk4"};

class Body : public testing::TestWithParam<std::tuple<std::string_view, std::string_view>> {
 protected:
  const Integrator& integrator() const { return *find_integrator(std::get<1>(GetParam())); }
  bool first_order() const { return integrator().order == 1; }
  std::unique_ptr<Backend> make(const System& system) const {
    return find_backend(std::get<0>(GetParam()))->make(system, integrator(), body_dt_s, {2, ""});
  }
};
INSTANTIATE_TEST_SUITE_P(BackendsAndIntegrators, Body,
                         testing::Combine(testing::ValuesIn(names_of(backends())),
                                          testing::ValuesIn(integrator_names)),
                         ByName());

TEST_P(Body, AtRestOnTheFloorStaysAndGainsNothing) {
  const System system = resting_block();
  const double total_j = energy_of(system, system.start).total();
  const auto backend = make(system);
  for (int look = 0; look < 4; ++look) {
    const State state = state_after(*backend, 500);
    const Energy energy = energy_of(system, state);
    // 1e-4 J is what lifting this block of 0.1 kg by 0.1 mm takes.
    EXPECT_LT(energy.total(), total_j + 1e-6);
    EXPECT_GT(energy.total(), total_j - 1e-4);
    EXPECT_LT(energy.kinetic, 1e-6);
    for (std::size_t i = 0; i < system.nodes(); ++i)
      EXPECT_LT(length(state.position[i] - system.start.position[i]), 1e-4) << "node " << i;
  }
}

TEST_P(Body, InFreeFallFollowsTheParabolaWithoutDeformation) {
  System system = relaxed_block(0.5);
  system.viscous_damping = 0;
  constexpr int steps = 2000;
  constexpr double time_s = steps * body_dt_s;
  const State state = state_after(*make(system), steps);
  const double fallen = system.gravity * time_s * time_s / 2;
  // Semi-implicit Euler falls with the speed that each step ends with.
  const double tolerance = 2e-6 + (first_order() ? system.gravity * time_s * body_dt_s / 2 : 0);
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    const Vec3d moved = state.position[i] - system.start.position[i];
    EXPECT_NEAR(moved.y, -fallen, tolerance) << "node " << i;
    EXPECT_NEAR(moved.x, 0, 2e-6) << "node " << i;
    EXPECT_NEAR(moved.z, 0, 2e-6) << "node " << i;
    EXPECT_NEAR(state.velocity[i].y, -system.gravity * time_s, 2e-4) << "node " << i;
  }
  for (const Spring& spring : system.springs)
    EXPECT_NEAR(length(state.position[spring.second] - state.position[spring.first]), spring.rest_length,
                1e-6);
}

TEST_P(Body, LeftToItselfKeepsItsMomenta) {
  System system = solid_block(3, 3, 3);
  system.gravity = 0;
  system.viscous_damping = 0;
  const Vec3d centre = momenta_of(system, system.start).centre;
  for (std::size_t i = 0; i < system.nodes(); ++i)
    system.start.velocity[i] += cross({4, -3, 5}, system.start.position[i] - centre);
  round_to_single(system.start);
  const Momenta before = momenta_of(system, system.start);
  const auto backend = make(system);
  backend->step(4000);
  const Momenta after = momenta_of(system, backend->state());
  EXPECT_LT(length(after.linear - before.linear), 1e-5 * length(before.linear));
  EXPECT_LT(length(after.angular - before.angular), 1e-4 * length(before.angular));
  EXPECT_LT(length(after.centre - before.centre - 4000 * body_dt_s / before.mass * before.linear), 1e-5);
}

TEST_P(Body, ThatSlidesStopsWhereCoulombsLawSays) {
  System system = resting_block();
  system.viscous_damping = 0;
  constexpr double speed = 0.3;
  for (Vec3d& v : system.start.velocity) v = {0.8 * speed, 0, -0.6 * speed};
  round_to_single(system.start);
  const double stop_s = speed / (system.floor.friction * system.gravity);
  const double distance = speed * stop_s / 2;
  const auto backend = make(system);
  const Vec3d start = momenta_of(system, system.start).centre;
  for (int look = 0; look < 2; ++look) {  // it sways a little on the spot, but it does not go on
    backend->step(static_cast<int>(1.5 * stop_s / body_dt_s));
    const Vec3d moved = momenta_of(system, backend->state()).centre - start;
    EXPECT_NEAR(std::hypot(moved.x, moved.z), distance, 0.1 * distance);
    EXPECT_NEAR(moved.z / moved.x, -0.75, 0.05);
  }
}

TEST_P(Body, ThatBouncesNeverGainsEnergy) {
  const System system = relaxed_block(0.02);
  const double start_j = energy_of(system, system.start).total();
  double lowest_j = start_j;
  const auto backend = make(system);
  for (int look = 0; look < 300; ++look) {
    backend->step(20);
    const double total_j = energy_of(system, backend->state()).total();
    EXPECT_LT(total_j, lowest_j + (first_order() ? 5e-3 : 1e-5) * start_j) << "step " << 20 * (look + 1);
    lowest_j = std::min(lowest_j, total_j);
  }
  EXPECT_LT(lowest_j, 0.8 * start_j) << "it has bounced";
}

}  // namespace
}  // namespace mssim
