// implicit-euler and newton-euler against their equations, written out.

#include "backends/implicit/newton/newton_method.h"
#include "backends/implicit/newton/spring_equation.h"
#include "backends/implicit/nodes/solvers.h"
#include "integrators/all_integrators.h"
#include "tests/support/backend_checks.h"
#include "tests/support/backward_euler.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

const Integrator& implicit_euler = *find_integrator("implicit-euler");
const Integrator& newton_euler = *find_integrator("newton-euler");

/// What velocities w leave of a step of Baraff and Witkin 1998, Eq. 6: |M (w - v) - dt (F + dF/dv (w - v) +
/// dt dF/dx w)| in the norm of M^-1, dF/dx without what compression and damping add to it.
double residual_of_linear_step(const System& system, const std::vector<Vec3d>& w, double dt_s) {
  const std::vector<Vec3d>&position = system.start.position, &velocity = system.start.velocity;
  std::vector<Vec3d> force = forces(system, system.start);
  for (const Spring& spring : system.springs) {
    const SpringMaterial& material = system.materials[spring.kind];
    const Vec3d d = position[spring.second] - position[spring.first], unit = 1 / length(d) * d;
    const Vec3d moved = dt_s * (w[spring.second] - w[spring.first]),
                faster =
                    w[spring.second] - velocity[spring.second] - w[spring.first] + velocity[spring.first];
    const double across =
        std::max(0.0, material.stiffness * (1 - static_cast<double>(spring.rest_length) / length(d)));
    const Vec3d change =
        (material.stiffness * dot(unit, moved) + material.damping * dot(unit, faster)) * unit +
        across * (moved - dot(unit, moved) * unit);
    force[spring.first] += change;
    force[spring.second] -= change;
  }
  for (const std::uint32_t pin : system.pins) force[pin] = {};
  double sum = 0;
  for (std::size_t i = 0; i < system.nodes(); ++i) {
    const double mass = system.node_mass[i];
    const Vec3d r = (1 + dt_s * system.viscous_damping) * mass * (w[i] - velocity[i]) - dt_s * force[i];
    sum += dot(r, r) / mass;
  }
  return std::sqrt(sum);
}

/// Small systems with compressed springs among the others; some have pins.
std::vector<System> small_systems() {
  return {cloth_system(5, 6), lone_cloth(1, 2), solid_block(2, 3, 2), pinned(solid_block(3, 2, 3), {0, 7})};
}
constexpr std::array<double, 3> steps_s{5e-5, 1e-3, 2e-2};

/// A cloth whose nodes move at random, by up to 5 m/s.
System stirred_cloth() {
  System system = cloth_system(20, 25);
  std::mt19937 generator(1);
  const auto random = [&] { return 10 * static_cast<double>(generator()) / 0x1p32 - 5; };
  for (Vec3d& v : system.start.velocity) v = {random(), random(), random()};
  round_to_single(system.start);
  return pinned(system, system.pins);
}

TEST(ImplicitEuler, IsTheSolutionOfItsLinearSystem) {
  for (const System& system : small_systems())
    for (const double dt_s : steps_s) {
      const double drifted = residual_of_linear_step(system, system.start.velocity, dt_s);
      const State after = state_after(*make_newton_reference(system, implicit_euler, dt_s, {}), 1);
      EXPECT_LT(residual_of_linear_step(system, after.velocity, dt_s), 1e-10 * drifted)
          << system.nodes() << " " << dt_s;
      for (std::size_t i = 0; i < system.nodes(); ++i)
        EXPECT_LT(length(after.position[i] - system.start.position[i] - dt_s * after.velocity[i]), 1e-15);
      const State in_single = state_after(*make_serial_newton(system, implicit_euler, dt_s, {}), 1);
      EXPECT_LT(residual_of_linear_step(system, in_single.velocity, dt_s), 1e-3 * drifted)
          << system.nodes() << " " << dt_s;
    }
}

TEST(NewtonEuler, LeavesNothingOfTheStepsEquation) {
  for (const System& system : small_systems())
    for (const double dt_s : steps_s) {
      const auto reference = make_newton_reference(system, newton_euler, dt_s, {});
      for (int step = 0; step < 5; ++step) {
        const State before = reference->state();
        State drifted = before;
        for (std::size_t i = 0; i < system.nodes(); ++i) drifted.position[i] += dt_s * before.velocity[i];
        reference->step(1);
        // What rounding of x + dt w leaves of the stiffest spring's force is 1e-16 of 1 m times 200 N/m.
        EXPECT_LT(residual_of(system, before, reference->state(), dt_s),
                  1e-10 * residual_of(system, before, drifted, dt_s))
            << system.nodes() << " nodes, dt " << dt_s << ", step " << step;
      }
      EXPECT_EQ(reference->note(), "");
    }
}

TEST(NewtonEuler, ChangesVelocitiesWithinItsTolerance) {
  // Stretched between its borders: where springs are compressed, eigenvalues of the Jacobian may be smaller
  // than those of A, and errors larger.
  System system = lone_cloth(20, 25);
  system.pins.clear();
  for (std::uint32_t node = 0; node < system.nodes(); ++node) {
    system.start.position[node] = 1.1 * system.start.position[node];
    const std::uint32_t row = node / 25, column = node % 25;
    if (row % 19 == 0 || column % 24 == 0) system.pins.push_back(node);
  }
  const auto norm = [&](const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < system.nodes(); ++i)
      sum += system.node_mass[i] * dot(a[i] - b[i], a[i] - b[i]);
    return std::sqrt(sum);
  };
  const SolverGoal goal{.tolerance = 1e-3};
  for (const double dt_s : {1e-4, 5e-3, 3e-2}) {  // the longest is 150 times what explicit methods can take
    SpringEquation<double> equation(system, dt_s);
    equation.set_state(system.start);
    SolverWork work;
    take_step(equation, newton_euler, goal, work);
    const std::vector<Vec3d> exact =
        state_after(*make_newton_reference(system, newton_euler, dt_s, {}), 1).velocity;
    EXPECT_LT(norm(equation.state().velocity, exact),
              (1 + goal.tolerance) * goal.tolerance * norm(exact, system.start.velocity))
        << dt_s;
  }
}

TEST(NewtonEuler, IsGivenUpWhereNobodyWaitsForIt) {
  const System system = stirred_cloth();
  int asked = 0;
  const auto reference = make_newton_reference(system, newton_euler, 1e-2, [&] { return ++asked == 3; });
  reference->step(10);
  EXPECT_EQ(asked, 3);
}

class NewtonOnThePlainList : public testing::TestWithParam<const Integrator*> {};
INSTANTIATE_TEST_SUITE_P(Integrators, NewtonOnThePlainList, testing::Values(&implicit_euler, &newton_euler),
                         [](const auto& test) {
                           return test.param == &implicit_euler ? "implicit_euler" : "newton_euler";
                         });

TEST_P(NewtonOnThePlainList, FollowsTheReferenceInSinglePrecision) {
  for (const System& system : small_systems())
    for (const double dt_s : {1e-4, 2e-3}) {
      const auto serial = make_serial_newton(system, *GetParam(), dt_s, {});
      const auto reference = make_newton_reference(system, *GetParam(), dt_s, {});
      EXPECT_LT(distance_after(20, *serial, *reference), 2e-5) << system.nodes() << " nodes, dt " << dt_s;
      EXPECT_EQ(serial->note(), "");
    }
}

TEST_P(NewtonOnThePlainList, TakesTheSameStepsInAnyUnitOfMass) {
  for (const System& system : small_systems()) {
    const auto expected = make_serial_newton(system, *GetParam(), 2e-3, {});
    expected->step(5);
    for (const double unit : {0x1p-40, 0x1p60}) {
      System other = system;
      for (double& mass : other.node_mass) mass *= unit;
      for (SpringMaterial& material : other.materials) {
        material.stiffness *= unit;
        material.damping *= unit;
      }
      const auto serial = make_serial_newton(other, *GetParam(), 2e-3, {});
      EXPECT_TRUE(same_state(state_after(*serial, 5), expected->state()))
          << system.nodes() << " nodes, " << unit;
      EXPECT_EQ(serial->note(), "");
    }
  }
}

TEST_P(NewtonOnThePlainList, HoldsPinsExactly) {
  for (const System& system : small_systems()) {
    const State state = state_after(*make_serial_newton(system, *GetParam(), 2e-3, {}), 30);
    EXPECT_TRUE(pins_hold(system, state));
    EXPECT_GT(largest_distance(state.position, system.start.position), 1e-4) << "the others move";
  }
}

TEST_P(NewtonOnThePlainList, PutsWhatFallsOntoTheFloor) {
  const System system = build_system(sheet_spec(5, 6, 0.001));
  const auto serial = make_serial_newton(system, *GetParam(), 2e-3, {});
  bool met = false;
  for (int step = 0; step < 30; ++step) {
    const State state = state_after(*serial, 1);
    for (const Vec3d& x : state.position) ASSERT_GE(x.y, system.floor.height);
    met = met || has_met_floor(system, state);
  }
  EXPECT_TRUE(met);
}

TEST_P(NewtonOnThePlainList, StartsAgainFromAStateThatItIsGiven) {
  const System system = cloth_system(9, 7);
  expect_starts_again(*make_serial_newton(system, *GetParam(), 1e-3, {}), system);
}

/// Expects that newton-euler follows the system for ten steps and has nothing to note. Returns the largest
/// part of the drifted state's residual that a step leaves.
double largest_part_left(const System& system, Backend& backend, double dt_s) {
  double most = 0;
  for (int step = 0; step < 10; ++step) {
    const State before = backend.state();
    State drifted = before;
    for (std::size_t i = 0; i < system.nodes(); ++i) drifted.position[i] += dt_s * before.velocity[i];
    most = std::max(most, residual_of(system, before, state_after(backend, 1), dt_s) /
                              residual_of(system, before, drifted, dt_s));
  }
  EXPECT_EQ(backend.note(), "") << dt_s;
  return most;
}

TEST(NewtonEuler, SolvesStepsThatTangleACloth) {
  // Nodes pass each other, by up to five rest lengths a step: across springs that this presses together, A is
  // not the Jacobian, and |r| falls along no part of s.
  System system = stirred_cloth();
  system.floor.height = -100;  // it is no part of the equation
  for (const double dt_s : {5e-4, 2.5e-3, 1e-2}) {
    EXPECT_LT(largest_part_left(system, *make_newton_reference(system, newton_euler, dt_s, {}), dt_s), 1e-9);
    // In double the tolerance is 1e-12. In single precision, rounding leaves up to 1e-4 here.
    EXPECT_LT(largest_part_left(system, *make_serial_newton(system, newton_euler, dt_s, {}), dt_s), 1e-3);
    EXPECT_LT(largest_part_left(system, *make_openmp_newton(system, newton_euler, dt_s, {2, {}}), dt_s),
              1e-3);
  }
}

TEST(SolverGoal, IsWhatRoundedSpringsLeave) {
  // One spring of k = 100 N/m, c = 5 N s/m and L = 1 m joins 1 kg and 0.5 kg; dt = 0.1 s. Its force is off by
  // u k L, which in the norm of r is u dt sqrt((k L)^2 (1 / 1 + 1 / 0.5)). It adds a = dt c + dt^2 k = 1.5 kg
  // to both masses: the columns' squares over the masses are (2.5^2 / 1 + 1.5^2 / 0.5) / 1 = 10.75 and (2^2 /
  // 0.5 + 1.5^2 / 1) / 0.5 = 20.5.
  System system;
  system.topology = TetrahedralMesh{};
  system.springs = {{0, 1, 1, 0}};
  system.materials = {{100, 5}};
  system.node_mass = {1, 0.5};
  system.start.position = {{0, 0, 0}, {1, 0, 0}};
  system.start.velocity.resize(2);
  const SolverGoal goal = solver_goal<float>(system, 0.1, 1e-3);
  EXPECT_EQ(goal.tolerance, 1e-3);
  EXPECT_NEAR(goal.rounding, 0x1p-24 * 0.1 * std::sqrt(3e4), 1e-18);
  EXPECT_NEAR(goal.rounding_of_motion, 0x1p-24 * std::sqrt(20.5), 1e-18);
}

TEST(NewtonEuler, SaysHowManyStepsItHasLeftUnfinished) {
  // A goal that rounding does not let it reach, and which is not taken for rounding's.
  const System system = stirred_cloth();
  SpringEquation<float> equation(system, 2.5e-3);
  SolverWork work;
  const SolverGoal unreachable{};
  for (int step = 0; step < 3; ++step) take_step(equation, newton_euler, unreachable, work);
  EXPECT_EQ(note_of(work), "the solver ended before its tolerance in 3 of 3 steps");
}

/// r = D w - b in two unknowns, D = diag(1, 1 + spread) and b = (1, 1), from w = 0 and without
/// preconditioner.
class TwoUnknowns {
 public:
  explicit TwoUnknowns(double spread) : diagonal_{1, 1 + spread} {}
  void begin() {}
  void linearise_at_state() {}
  double linearise() {
    for (std::size_t i = 0; i < 2; ++i) left_[i] = 1 - diagonal_[i] * w_[i];
    return square_of_left();
  }
  double start_solving() {
    solution_ = direction_ = {};
    return square_of_left();
  }
  double turn(double factor) {
    double curvature = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      direction_[i] = left_[i] + factor * direction_[i];
      curvature += diagonal_[i] * direction_[i] * direction_[i];
    }
    return curvature;
  }
  double advance(double factor) {
    for (std::size_t i = 0; i < 2; ++i) {
      solution_[i] += factor * direction_[i];
      left_[i] -= factor * diagonal_[i] * direction_[i];
    }
    return square_of_left();
  }
  void add(double factor) {
    for (std::size_t i = 0; i < 2; ++i) w_[i] += factor * solution_[i];
  }
  double along_solution() { return left_[0] * solution_[0] + left_[1] * solution_[1]; }
  double motion() { return w_[0] * w_[0] + w_[1] * w_[1]; }
  double change() { return motion(); }
  void end() {}
  void scale_left(double factor) {
    for (double& left : left_) left *= factor;
  }

 private:
  double square_of_left() const { return left_[0] * left_[0] + left_[1] * left_[1]; }
  std::array<double, 2> diagonal_, left_{}, solution_{}, direction_{}, w_{};
};

TEST(NewtonEuler, SolvesLinearSystemsToAHundredthOfWhatIsLeft) {
  // The first iteration of conjugate gradients goes 2 / (2 + spread) of (1, 1), which leaves spread / (2 +
  // spread) of |e|, and the second nothing.
  for (const auto& [spread, products] : {std::pair{0.0202, 1U}, {0.0203, 2U}}) {
    EXPECT_EQ(spread / (2 + spread) <= 0.01, products == 1);
    TwoUnknowns equation(spread);
    SolverWork work;
    newtons_method(equation, {.rounding = 0.1}, work);
    EXPECT_EQ(work.newton_iterations, 1U);
    EXPECT_EQ(work.products, products) << spread;
  }
}

TEST(NewtonEuler, EndsAStepThatIsNotFinite) {
  TwoUnknowns equation(NAN);
  SolverWork work;
  newtons_method(equation, {.rounding = 0.1}, work);
  EXPECT_EQ(work.newton_iterations, 1U);
  EXPECT_EQ(work.unfinished_steps, 1U);
}

TEST(ConjugateGradients, DoNotSolveWhatIsNotFinite) {
  for (const double infinite : {HUGE_VAL, double{NAN}}) {
    TwoUnknowns equation(0);
    SolverWork work;
    equation.linearise();
    equation.scale_left(infinite);
    EXPECT_FALSE(conjugate_gradients(equation, 0.01, work).solved);
  }
}

TEST(ConjugateGradients, SayWhereTheyEndBeforeTheirTolerance) {
  System system = cloth_system(30, 40);
  system.solver.tolerance = 0;  // which no sum comes to
  const auto serial = make_serial_newton(system, implicit_euler, 0.05, {});
  EXPECT_EQ(serial->note(), "");
  serial->step(2);
  EXPECT_EQ(serial->note(), "the solver ended before its tolerance in 2 of 2 steps");
}

}  // namespace
}  // namespace mssim
