// What the integrators do, measured on the double-precision reference.

#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "integrators/stability.h"
#include "model/system.h"
#include "tests/support/backend_checks.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// Of all whose solvers are written, those that are implicit or those that are not.
std::vector<std::string_view> names_of_integrators(bool implicit) {
  std::vector<std::string_view> names;
  for (const Integrator* integrator : all_integrators)
    if (is_implicit(*integrator) == implicit && integrator->solver != Solver::local_global &&
        integrator->solver != Solver::constraints)
      names.push_back(integrator->name);
  return names;
}

class EachIntegrator : public testing::TestWithParam<std::string_view> {
 protected:
  /// The table's own row: backends tell rows apart by address.
  const Integrator& integrator() const { return *find_integrator(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Explicit, EachIntegrator, testing::ValuesIn(names_of_integrators(false)), ByName());
INSTANTIATE_TEST_SUITE_P(Implicit, EachIntegrator, testing::ValuesIn(names_of_integrators(true)), ByName());

class EachImplicitIntegrator : public EachIntegrator {};
INSTANTIATE_TEST_SUITE_P(Table, EachImplicitIntegrator, testing::ValuesIn(names_of_integrators(true)),
                         ByName());

State state_after(const System& system, const Integrator& integrator, double dt_s, int steps) {
  return state_after(*make_reference(system, integrator, dt_s), steps);
}

/// The order that twice as many steps over a hundredth of a second show. Methods of order 1 show theirs only
/// with short steps, because the error of one distorts the next.
double measured_order(const System& system, const Integrator& integrator, int expected) {
  constexpr double duration_s = 0.01;
  const State exact = state_after(system, *find_integrator("rk4"), duration_s / 20000, 20000);
  const auto error = [&](int steps) {
    return largest_distance(state_after(system, integrator, duration_s / steps, steps).position,
                            exact.position);
  };
  const int steps = expected == 1 ? 4000 : 250;
  return std::log2(error(steps) / error(2 * steps));
}

TEST_P(EachIntegrator, ConvergesWithItsOrderWhereVelocitiesDamp) {
  const int order = integrator().damped_order;
  EXPECT_NEAR(measured_order(cloth_system(5, 5), integrator(), order), order, 0.15);
}

TEST_P(EachIntegrator, ConvergesWithItsOrderWhereNothingDamps) {
  const int order = integrator().order;
  EXPECT_NEAR(measured_order(undamped(cloth_system(5, 5)), integrator(), order), order, 0.15);
}

/// One step of x' = v, v' = -w^2 x as a matrix {xx, xv, vx, vv}: for Runge-Kutta methods of as many stages as
/// their order the Taylor polynomial of exp(dt A) up to it, worked out by hand for the others.
std::array<double, 4> recurrence(const Integrator& integrator, double w, double dt) {
  const std::string_view name = integrator.name;
  const double q = w * w * dt * dt;
  if (integrator.order > 1 && integrator.order == static_cast<int>(integrator.stage_count)) {
    double even = 0, odd = 0, term = 1;  // of cos(w dt), and of sin(w dt) / (w dt)
    for (int n = 0; n <= integrator.order; n += 2) {
      even += term;
      term /= n + 1;
      if (n < integrator.order) odd += term;
      term *= -q / (n + 2);
    }
    return {even, dt * odd, -w * w * dt * odd, even};
  }
  if (name == "semi-euler") return {1 - q, dt, -w * w * dt, 1};
  // Held acceleration: x+ = x + dt v + dt^2/2 a, v+ = v + dt a.
  if (name == "midpoint-frozen" || name == "rk4-frozen") return {1 - q / 2, dt, -w * w * dt, 1};
  if (name == "explicit-euler") return {1, dt, -w * w * dt, 1};
  // v+ = v - w^2 dt (x + dt/2 v), x+ = x + dt/2 v + dt/2 v+.
  if (name == "verlet") return {1 - q / 2, dt * (1 - q / 4), -w * w * dt, 1 - q / 2};
  // v+ = (v - dt w^2 x) / (1 + w^2 dt^2), x+ = x + dt v+.
  if (name == "implicit-euler" || name == "newton-euler")
    return {1 / (1 + q), dt / (1 + q), -w * w * dt / (1 + q), 1 / (1 + q)};
  return {};
}

TEST_P(EachIntegrator, FollowsItsOwnRecurrenceForAnUndampedOscillator) {
  System system = lone_cloth(1, 2);
  system.pins = {0};
  system.materials = {{200, 0}, {60, 0}, {8, 0}};
  const double rest = static_cast<double>(system.springs.at(0).rest_length);
  system.start.position = {{0, 1, 0}, {1.05 * rest, 1, 0}};
  system.start.velocity = {{}, {0.15, 0, 0}};
  const double w = std::sqrt(200 / system.node_mass[0]), dt = 0.1 / w;
  const auto [xx, xv, vx, vv] = recurrence(integrator(), w, dt);
  ASSERT_NE(vv, 0) << "no recurrence was worked out for this integrator";

  double x = 0.05 * rest, v = 0.15;
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

/// With which nothing grows, s.
double small_dt_of(const Integrator& integrator) { return integrator.name == "explicit-euler" ? 1e-5 : 1e-4; }

TEST_P(EachIntegrator, LetsAnUnstrainedSheetFallWithoutDeformingIt) {
  SceneSpec spec = sheet_spec(9, 11, 1);
  spec.viscous_damping_per_s = 0;
  const System system = build_system(spec);
  const double time = 0.05, dt = small_dt_of(integrator()), g = spec.gravity_m_per_s2;
  const int steps = static_cast<int>(std::lround(time / dt));
  const double fall = g * dt * dt * fall_of(integrator(), steps);
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
  const double dt = small_dt_of(integrator());
  const State end = state_after(system, integrator(), dt, static_cast<int>(std::lround(0.03 / dt)));
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

/// An unpinned cloth that nothing acts on and nothing damps, as stretched as it is compressed somewhere.
System free_oscillation() {
  System system = undamped(lone_cloth(6, 7));
  for (std::size_t i = 0; i < system.nodes(); ++i)
    system.start.velocity[i] += Vec3d{0.05 * std::sin(300. * static_cast<double>(i)), 0,
                                      0.05 * std::cos(170. * static_cast<double>(i))};
  return system;
}

/// Total energies after each of `steps` steps, as parts of the first.
std::vector<double> energies(const System& system, const Integrator& integrator, double dt_s, int steps) {
  const auto backend = make_reference(system, integrator, dt_s);
  const double first = energy_of(system, system.start).total();
  std::vector<double> parts;
  for (int step = 0; step < steps; ++step) {
    parts.push_back(energy_of(system, state_after(*backend, 1)).total() / first);
  }
  return parts;
}

double explicit_limit_s(const System& system) {
  return largest_stable_dt(*find_integrator("semi-euler"), mode_bound(system));
}

TEST(EnergyWithoutDamping, FallsInEveryStepOfBackwardEuler) {
  const System system = free_oscillation();
  for (const char* name : {"implicit-euler", "newton-euler"})
    for (const double dt_s : {explicit_limit_s(system) / 5, 10 * explicit_limit_s(system)}) {
      double before = 1;
      for (const double part : energies(system, *find_integrator(name), dt_s, 200)) {
        EXPECT_LT(part, before) << name << " " << dt_s;
        before = part;
      }
      EXPECT_LT(before, 0.9) << name << " " << dt_s;
    }
}

TEST(EnergyWithoutDamping, StaysWithinItsFirstErrorWithVerlet) {
  const System system = free_oscillation();
  const double dt_s = explicit_limit_s(system) / 10;
  const std::vector<double> parts = energies(system, verlet, dt_s, 20000);
  const auto largest_error = [&](std::size_t from, std::size_t to) {
    double largest = 0;
    for (std::size_t i = from; i < to; ++i) largest = std::max(largest, std::abs(parts[i] - 1));
    return largest;
  };
  const double early = largest_error(0, 2000);
  EXPECT_GT(early, 1e-5) << "there is an error to stay within";
  EXPECT_LT(early, 0.05);
  EXPECT_LT(largest_error(18000, 20000), 1.5 * early);
}

TEST(EnergyWithoutDamping, GrowsWithoutEndWithExplicitEuler) {
  const System system = free_oscillation();
  const std::vector<double> parts =
      energies(system, *find_integrator("explicit-euler"), explicit_limit_s(system) / 50, 2000);
  for (std::size_t i = 100; i < parts.size(); i += 100) EXPECT_GT(parts[i], 1.005 * parts[i - 100]) << i;
}

TEST_P(EachImplicitIntegrator, IsStableFarBeyondTheExplicitLimit) {
  const System system = cloth_system(15, 17);
  const double dt_s = 50 * explicit_limit_s(system);
  const double total_j = energy_of(system, system.start).total();
  const auto backend = make_reference(system, integrator(), dt_s);
  for (int look = 0; look < 30; ++look) {
    const State state = state_after(*backend, 10);
    for (const std::uint32_t pin : system.pins) EXPECT_EQ(state.position[pin], system.start.position[pin]);
    const Energy energy = energy_of(system, state);
    ASSERT_LT(energy.total(), total_j) << "after " << 10 * (look + 1) << " steps";
    // A mean strain of a tenth: what hangs is nowhere near that.
    ASSERT_LT(energy.elastic, 0.01) << "after " << 10 * (look + 1) << " steps";
  }
  EXPECT_LT(energy_of(system, backend->state()).gravitational, energy_of(system, system.start).gravitational)
      << "it hangs";
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
