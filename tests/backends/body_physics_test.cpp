// What every backend must make of a tetrahedral body: laws of mechanics that need no reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <tuple>

#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "tests/support/backend_checks.h"

namespace mssim {
namespace {

constexpr double body_dt_s = 5e-5;

/// A block whose springs are at rest, and which is at rest itself.
System relaxed_block(double height_m) {
  System system = solid_block(3, 3, 3, height_m);
  for (Spring& spring : system.springs) {
    const Vec3d d = system.start.position[spring.second] - system.start.position[spring.first];
    spring.rest_length = static_cast<float>(std::sqrt(dot(d, d)));
  }
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

Vec3d centre_of(const System& system, const State& state) {
  double mass = 0;
  Vec3d sum;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    mass += system.node_mass[i];
    sum += system.node_mass[i] * state.position[i];
  }
  return 1 / mass * sum;
}

constexpr std::array<std::string_view, 3> integrator_names{"semi-euler", "midpoint", "rk4"};

class Body : public testing::TestWithParam<std::tuple<std::string_view, std::string_view>> {
 protected:
  std::unique_ptr<Backend> make(const System& system) const {
    const auto [backend, integrator] = GetParam();
    return find_backend(backend)->make(system, *find_integrator(integrator), body_dt_s, {2, ""});
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
    backend->step(500);
    const State state = backend->state();
    const Energy energy = energy_of(system, state);
    // 1e-4 J is what lifting this block of 0.1 kg by 0.1 mm takes.
    EXPECT_LT(energy.total(), total_j + 1e-6);
    EXPECT_GT(energy.total(), total_j - 1e-4);
    EXPECT_LT(energy.kinetic, 1e-6);
    for (std::size_t i = 0; i < system.nodes(); ++i)
      EXPECT_LT(length(state.position[i] - system.start.position[i]), 1e-4) << "node " << i;
  }
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
  const Vec3d start = centre_of(system, system.start);
  for (int look = 0; look < 2; ++look) {  // it sways a little on the spot, but it does not go on
    backend->step(static_cast<int>(1.5 * stop_s / body_dt_s));
    const Vec3d moved = centre_of(system, backend->state()) - start;
    EXPECT_NEAR(std::hypot(moved.x, moved.z), distance, 0.1 * distance);
    EXPECT_NEAR(moved.z / moved.x, -0.75, 0.05);
  }
}

}  // namespace
}  // namespace mssim
