#include "guide/work_precision.h"

#include "backends/backends.h"
#include "bench/verification/verification.h"
#include "guide/guide.h"
#include "integrators/all_integrators.h"
#include "tests/bench/bench_scene_fixture.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// The state after 10 ms.
TrustedState trusted_after_10_ms(const System& system, double wanted_error = 1e-9) {
  return trusted_state(system,
                       {.longest_s = 0.01, .first_dt_s = 1e-4, .seconds = 100, .wanted_error = wanted_error});
}

StepLimit limit_of(std::string_view integrator, double stable_s = 2.2e-4) {
  StepLimit limit;
  limit.integrator = find_integrator(integrator);
  limit.measured = {.stable_s = stable_s, .unstable_s = 1.01 * stable_s};
  return limit;
}

/// Points of a method on serial over 10 ms, the limit taken as given, and the trusted state's own error if it
/// is.
std::vector<WorkPoint> curve_of(std::string_view integrator, double stable_s, double wanted_error,
                                double own_error = 0) {
  const System system = cloth_system(8, 8);
  TrustedState trusted = trusted_after_10_ms(system);
  trusted.own_error = std::max(trusted.own_error, own_error);
  const StepLimit limit = limit_of(integrator, stable_s);
  GuidedMethod method{limit.integrator, find_backend("serial")};
  WorkCurve curve(system, trusted, limit, method, {.threads = 1}, wanted_error);
  while (curve.has_next()) curve.next();
  return method.points;
}

TEST(WorkCurve, FallsWithTheOrderOfItsMethod) {
  const std::vector<WorkPoint> euler = curve_of("semi-euler", 2.2e-4, 1e-3);
  ASSERT_GE(euler.size(), 4U);
  for (std::size_t i = 2; i + 1 < euler.size(); ++i)
    EXPECT_NEAR(*euler[i].position_error / *euler[i + 1].position_error, 2, 0.3) << i;
  const std::vector<WorkPoint> midpoint = curve_of("midpoint", 1.8e-4, 1e-3);
  ASSERT_GE(midpoint.size(), 3U);
  EXPECT_NEAR(*midpoint[1].position_error / *midpoint[2].position_error, 4, 0.8);
}

TEST(WorkCurve, BeginsWithAStepThatDiverges) {
  const std::vector<WorkPoint> points = curve_of("semi-euler", 2.2e-4, 1e-3);
  EXPECT_TRUE(points[0].diverged);
  EXPECT_FALSE(points[0].counts());
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_TRUE(points[i].counts()) << i;
    EXPECT_EQ(points[i].steps, 2 * points[i - 1].steps) << i;
    EXPECT_NEAR(points[i].dt_s * points[i].steps, 0.01, 1e-12) << i;
    EXPECT_EQ(points[i].evaluations, 1) << i;
    EXPECT_GT(points[i].seconds_a_step, 0) << i;
  }
}

TEST(WorkCurve, EndsWithAQuarterOfTheWishedError) {
  const std::vector<WorkPoint> all = curve_of("semi-euler", 2.2e-4, 1e-6);
  ASSERT_GE(all.size(), 6U);
  const double fifth = *all[4].position_error;
  EXPECT_EQ(curve_of("semi-euler", 2.2e-4, 4.01 * fifth).size(), 5U);
  EXPECT_EQ(curve_of("semi-euler", 2.2e-4, 3.99 * fifth).size(), 6U);
}

TEST(WorkCurve, CountsErrorsOfFiftyTimesTheTrustedStatesOrMore) {
  const double second = *curve_of("semi-euler", 2.2e-4, 1e-3)[2].position_error;
  EXPECT_FALSE(curve_of("semi-euler", 2.2e-4, 1e-3, second / 50.1).at(2).beyond_trust);
  EXPECT_TRUE(curve_of("semi-euler", 2.2e-4, 1e-3, second / 49.9).at(2).beyond_trust);
}

TEST(WorkCurve, HasNothingWhereNoStepIsStable) { EXPECT_TRUE(curve_of("explicit-euler", 0, 1e-3).empty()); }

TEST(WorkCurve, IsUnsupportedWithoutSpendingTimeWhereTheBackendLacksTheIntegrator) {
  const System system = cloth_system(8, 8);
  StepLimit unfinished;  // as of a guide whose time ended before it had found a stable step
  unfinished.integrator = find_integrator("newton-euler");
  GuidedMethod method{unfinished.integrator, find_backend("opencl")};
  const WorkCurve curve(system, {}, unfinished, method, {.threads = 1}, 1e-6);
  EXPECT_FALSE(curve.has_next());
  EXPECT_EQ(method.ending.lack, Lack::unsupported);
  EXPECT_THAT(method.ending.status(), testing::HasSubstr("implicit"));
}

TEST(WorkCurve, EndsWithAProgramThatPostponesItsSteps) {
  const System system = cloth_system(30, 30);
  const TrustedState trusted = trusted_after_10_ms(system, 1e-3);
  const StepLimit limit = limit_of("semi-euler");
  GuidedMethod method{limit.integrator, &postponing};
  WorkCurve curve(system, trusted, limit, method, {.threads = 1}, 1e-3);
  EXPECT_FALSE(curve.next());
  EXPECT_FALSE(curve.has_next());
  EXPECT_EQ(method.ending.lack, Lack::failed);
  EXPECT_THAT(method.ending.status(), StartsWith("failed: it reports steps before they are done"));
}

/// A backend whose steps take a while but change nothing.
class Frozen : public OtherSerial {
 public:
  using OtherSerial::OtherSerial;
  void step(int /*count*/) override {
    for (const Stopwatch watch; watch.seconds() < 1e-4;) {
    }
  }
};
constexpr BackendInfo frozen = row_of<Frozen>("frozen");

/// Lower than its start by a distance.
class Lowered final : public Frozen {
 public:
  Lowered(std::unique_ptr<Backend> serial, double distance_m)
      : Frozen(std::move(serial)), distance_m_(distance_m) {}
  State state() const override {
    State state = Frozen::state();
    for (Vec3d& x : state.position) x.y -= distance_m_;
    return state;
  }

 private:
  double distance_m_;
};

/// Each halving of a step of 10 ms / 24 takes it `per_mille` of the way that a sheet falls in 10 ms.
template <int per_mille>
std::unique_ptr<Backend> make_creeping(const System& system, const Integrator& integrator, double dt_s,
                                       const ExecutionOptions& options) {
  const double halvings = std::log2(0.01 / 24 / dt_s), fall_m = 0.5 * system.gravity * 0.01 * 0.01;
  return std::make_unique<Lowered>(find_backend("serial")->make(system, integrator, dt_s, options),
                                   1e-3 * per_mille * halvings * fall_m);
}
template <int per_mille>
constexpr BackendInfo creeping{.name = "creeping", .make = make_creeping<per_mille>};

class Astray final : public Frozen {
 public:
  using Frozen::Frozen;
  State state() const override {
    State state = Frozen::state();
    state.position[7].y = std::numeric_limits<double>::quiet_NaN();
    return state;
  }
};
constexpr BackendInfo astray = row_of<Astray>("astray");

class Crowded final : public OtherSerial {
 public:
  using OtherSerial::OtherSerial;
  std::string reason_not_to_time() const override { return "too crowded"; }
};
constexpr BackendInfo crowded = row_of<Crowded>("crowded");

/// semi-euler on the backend over 10 ms.
GuidedMethod curve_on(const BackendInfo& backend, double stable_span_s,
                      const System& system = cloth_system(8, 8)) {
  const TrustedState trusted = trusted_after_10_ms(system);
  StepLimit limit = limit_of("semi-euler");
  limit.measured.span_s = stable_span_s;
  GuidedMethod method{limit.integrator, &backend};
  WorkCurve curve(system, trusted, limit, method, {.threads = 1}, 1e-6);
  while (curve.has_next()) curve.next();
  return method;
}

TEST(WorkCurve, EndsWithABackendWhoseStableStepsDiverge) {
  // The first step is longer than the largest stable one.
  const GuidedMethod method = curve_on(astray, 0.2);
  EXPECT_EQ(method.points.size(), 4U);
  EXPECT_EQ(method.ending.lack, Lack::failed);
  EXPECT_THAT(method.ending.status(), StartsWith("failed: its energy grows or is not finite with 3 steps"));
  // Where steps were stable for a shorter time than the horizon, smaller ones may not diverge.
  const GuidedMethod unstable = curve_on(astray, 0.005);
  EXPECT_EQ(unstable.points.size(), 11U);
  EXPECT_EQ(unstable.ending.lack, Lack::stable_step);
  EXPECT_THAT(unstable.ending.status(), HasSubstr("no step that was tried is stable"));
}

TEST(WorkCurve, EndsWhereTwoHalvingsLeaveALargeError) {
  // In 10 ms free nodes fall by 0.05 of a rest length.
  const GuidedMethod method = curve_on(frozen, 0.2);
  EXPECT_EQ(method.points.size(), 4U);
  EXPECT_EQ(method.ending.lack, Lack::nothing);
  EXPECT_THAT(method.ending.status(),
              AllOf(StartsWith("smaller steps are no more accurate"), HasSubstr("another system")));
}

TEST(WorkCurve, TakesALargeErrorForUnchangedWithinOnePercent) {
  const System sheet = build_system(sheet_spec(8, 8, 1));
  // Each halving changes it by 0.8 %, and by 1.2 % to 1.4 %.
  EXPECT_EQ(curve_on(creeping<8>, 0.2, sheet).points.size(), 4U);
  EXPECT_EQ(curve_on(creeping<12>, 0.2, sheet).points.size(), 11U);
}

TEST(WorkCurve, HasNoTimesThatMeanNothing) {
  const GuidedMethod method = curve_on(crowded, 0.2);
  EXPECT_THAT(method.points, IsEmpty());
  EXPECT_EQ(method.ending.lack, Lack::not_timed);
  EXPECT_EQ(method.ending.status(), "not timed: too crowded");
  const System system = cloth_system(8, 8);
  const TrustedState trusted = trusted_after_10_ms(system, 1e-3);
  const StepLimit limit = limit_of("semi-euler");
  GuidedMethod one{limit.integrator, &crowded};
  WorkCurve(system, trusted, limit, one, {.threads = 1}, 1e-6).time_step();
  EXPECT_EQ(one.ending.status(), "not timed: too crowded");
  EXPECT_EQ(one.step_seconds, 0);
  std::vector<SizeCurve> sizes{{.integrator = limit.integrator, .backend = &crowded, .dt_s = 1e-4}};
  measure_sizes(
      sizes, [](std::uint32_t side) { return FamilyCloth{cloth_system(side, side)}; }, {.threads = 1},
      [](const std::string&) { return true; });
  EXPECT_THAT(sizes[0].samples, IsEmpty());
  EXPECT_EQ(sizes[0].status, "not timed: too crowded");
}

TEST(WorkCurve, SaysForWhichStepsThereWasNoTime) {
  const System system = cloth_system(8, 8);
  const TrustedState trusted = trusted_after_10_ms(system);
  const StepLimit limit = limit_of("semi-euler");
  std::vector<std::string> statuses;
  for (const int points : {0, 1, 2}) {  // none, one that diverges, and one that counts
    GuidedMethod method{limit.integrator, find_backend("serial")};
    WorkCurve curve(system, trusted, limit, method, {.threads = 1}, 1e-6);
    int steps = first_steps(*limit.integrator, limit.measured, trusted.horizon_s);
    for (int taken = 0; taken < points; ++taken, steps *= 2) curve.next();
    curve.end_without_time();
    EXPECT_FALSE(curve.has_next());
    EXPECT_EQ(method.ending.lack, Lack::time);
    ASSERT_TRUE(method.next);
    EXPECT_DOUBLE_EQ(method.next->dt_s, trusted.horizon_s / steps);
    EXPECT_EQ(method.next->later, 10 - points);  // of 11
    EXPECT_GT(method.next->seconds, 0);
    statuses.push_back(method.ending.status());
  }
  for (const std::size_t without_any : {0U, 1U})
    EXPECT_THAT(statuses[without_any], Not(HasSubstr("smaller")));
  EXPECT_THAT(statuses[2], HasSubstr("smaller"));
  EXPECT_NE(statuses[0], statuses[1]);
}

TEST(WorkCurve, TimesAStepOnABackendThatIsNotTheLimits) {
  const System system = cloth_system(8, 8);
  const TrustedState trusted = trusted_after_10_ms(system);
  StepLimit limit;
  limit.integrator = find_integrator("rk4");
  limit.backend = "openmp";
  limit.step_seconds = 10;
  limit.measured = {.stable_s = 2.2e-4, .unstable_s = 2.21e-4};
  GuidedMethod method{limit.integrator, find_backend("openmp")};
  EXPECT_TRUE(WorkCurve(system, trusted, limit, method, {.threads = 1}, 1e-3).is_timed());
  EXPECT_EQ(method.step_seconds, 10);
  method = {limit.integrator, find_backend("serial")};
  WorkCurve curve(system, trusted, limit, method, {.threads = 1}, 1e-3);
  EXPECT_FALSE(curve.is_timed());
  EXPECT_GT(curve.next_seconds(), 100) << "as on openmp";
  curve.time_step();
  EXPECT_TRUE(curve.is_timed());
  EXPECT_GT(method.step_seconds, 0);
  EXPECT_LT(curve.next_seconds(), 100);
}

TEST(TimedRuns, TakeWhatTheirNumberAndLengthSay) {
  EXPECT_DOUBLE_EQ(seconds_of_runs(0.001, 0.03), 0.03);  // thirty runs
  EXPECT_DOUBLE_EQ(seconds_of_runs(0.02, 0.03), 0.1);    // five
  EXPECT_DOUBLE_EQ(seconds_of_runs(0.2, 0.03), 0.3);     // two
  EXPECT_DOUBLE_EQ(seconds_of_runs(2, 0.03), 2);         // one
}

TEST(WorkCurve, CountsNoStepBeyondTheLargestStableOne) {
  const double limit = 0.003;
  const std::vector<WorkPoint> points = curve_of("implicit-euler", limit, 1e-3);
  ASSERT_GE(points.size(), 3U);
  EXPECT_GT(points[0].dt_s, limit);
  for (const WorkPoint& point : points) {
    EXPECT_FALSE(point.diverged) << point.dt_s;
    EXPECT_EQ(point.within_limit, point.dt_s <= limit) << point.dt_s;
    EXPECT_EQ(point.counts(), point.within_limit) << point.dt_s;
  }
  for (const WorkPoint& point : curve_of("implicit-euler", 0, 1e-3))
    EXPECT_FALSE(point.counts()) << point.dt_s;
}

TEST(WorkCurve, OfImplicitMethodsSharesNumbersOfSteps) {
  const Integrator &implicit = *find_integrator("implicit-euler"), &verlet = *find_integrator("verlet");
  // The fewest that are no longer than the longest of use, whatever is stable.
  EXPECT_EQ(first_steps(implicit, {.stable_s = longest_useful_step_s}, 0.1), 3);
  EXPECT_EQ(first_steps(implicit, {.stable_s = 0.004, .unstable_s = 0.00404}, 0.1), 3);
  // Twice the longest stable step.
  EXPECT_EQ(first_steps(verlet, {.stable_s = 0.1 / 950, .unstable_s = 0.1 / 949}, 0.1), 500);
}

TEST(EnergyBound, IsWhatTheSystemHasAndGravityGives) {
  System system = cloth_system(6, 6);
  const double start = energy_of(system, system.start).total();
  EXPECT_GT(energy_bound(system, 0.1), start);
  EXPECT_GT(energy_bound(system, 0.1), energy_bound(system, 0.01));
  // No more than down to the floor.
  EXPECT_DOUBLE_EQ(energy_bound(system, 10), energy_bound(system, 20));
  // 2 kg at 3 m with 2 m/s have 4 J and 60 J. In 0.1 s they fall by 0.05 m, which gives 1 J; in 10 s to the
  // floor.
  system = {};
  system.node_mass = {2};
  system.gravity = 10;
  system.start.position = {{0, 3, 0}};
  system.start.velocity = {{2, 0, 0}};
  EXPECT_NEAR(energy_bound(system, 0.1), 64 + 0.01 * (4 + 1), 1e-12);
  EXPECT_NEAR(energy_bound(system, 10), 64 + 0.01 * (4 + 60), 1e-12);
}

TEST(EnergyBound, LeavesRoomForTheRoundingsOfASceneAtRest) {
  System system = build_system(sheet_spec(10, 10, 0.5));
  system.gravity = 0;
  const Integrator& euler = *find_integrator("semi-euler");
  const auto openmp = make_backend(*find_backend("openmp"), system, euler, 5e-5, {.threads = 1});
  EXPECT_TRUE(stays_below(*openmp, system, 2000, energy_bound(system, 0.1)));
  // Still so small that a step that is too large is found.
  const auto wild = make_backend(*find_backend("openmp"), system, euler, 2e-3, {.threads = 1});
  EXPECT_FALSE(stays_below(*wild, system, 2000, energy_bound(system, 4)));
}

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
  EXPECT_EQ(trusted.short_of_s, 0);
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
  EXPECT_THAT(trusted.why_there, HasSubstr("floor"));
}

TEST(TrustedState, SaysThatThereIsNoHorizon) {
  const System system = build_system(sheet_spec(4, 4, 1e-6));
  EXPECT_THAT(trusted_state(system, {.longest_s = 1, .first_dt_s = 1e-4, .seconds = 100}).failure,
              HasSubstr("no horizon"));
}

TEST(TrustedState, IsNotBegunWithoutTimeForAStep) {
  const TrustedState trusted =
      trusted_state(cloth_system(9, 9), {.longest_s = 0.02, .first_dt_s = 1e-4, .seconds = 1e-9});
  EXPECT_THAT(trusted.failure, HasSubstr("no time"));
  EXPECT_GT(trusted.short_of_s, 1e-9);
}

TEST(TrustedState, EndsItsHorizonWhereNeighboursPart) {
  // Compressed springs: a node beside the line runs off, faster and faster.
  System system = spring_chain(5);
  for (Spring& spring : system.springs) spring.rest_length = 0.012F;
  const TrustedState trusted = trusted_state(system, {.longest_s = 0.02, .first_dt_s = 1e-5, .seconds = 100});
  ASSERT_EQ(trusted.failure, "");
  EXPECT_LT(trusted.horizon_s, 0.01);
  EXPECT_LE(trusted.parting, allowed_parting);
  EXPECT_THAT(trusted.why_there, HasSubstr("neighbouring trajectories part"));
}

/// Both Newton methods with a few steps over 20 ms, and where they ended.
struct Measured {
  System system = cloth_system(8, 8);
  TrustedState trusted =
      trusted_state(system, {.longest_s = 0.02, .first_dt_s = 1e-4, .seconds = 100, .wanted_error = 1e-7});
  std::vector<GuidedMethod> methods{{find_integrator("implicit-euler"), find_backend("serial")},
                                    {find_integrator("newton-euler"), find_backend("serial")}};
  std::vector<ImplicitEnd> ends;

  Measured() {
    for (GuidedMethod& method : methods)
      for (const int steps : {8, 16, 32}) {
        const auto backend = make_backend(*method.backend, system, *method.integrator,
                                          trusted.horizon_s / steps, {.threads = 1});
        backend->step(steps);
        ends.push_back({&method, method.points.size(), backend->state()});
        WorkPoint& point = method.points.emplace_back();
        point.steps = steps;
        point.position_error = position_deviation(system, trusted.state, ends.back().state);
      }
  }
};

TEST(ExactSteps, TellTheErrorOfTheSolverFromThatOfTheStep) {
  Measured measured;
  tell_errors_apart(measured.methods, measured.ends, measured.system, measured.trusted, [] { return false; });
  for (const GuidedMethod& method : measured.methods)
    for (const WorkPoint& point : method.points) {
      ASSERT_TRUE(point.solver_error && point.step_error) << point.steps;
      EXPECT_LE(*point.position_error, *point.solver_error + *point.step_error);
      EXPECT_GE(*point.position_error, *point.step_error - *point.solver_error);
      // newton-euler solves the step's equation, to its tolerance and what single precision leaves.
      if (method.integrator->solver == Solver::newton)
        EXPECT_LT(*point.solver_error, 1e-3 * *point.step_error) << point.steps;
      else
        EXPECT_GT(*point.solver_error, 1e-2 * *point.step_error) << point.steps;
    }
  const std::vector<WorkPoint>& points = measured.methods[0].points;
  EXPECT_LT(*points[1].step_error, *points[0].step_error);
  EXPECT_LT(*points[2].step_error, *points[1].step_error);
  EXPECT_EQ(points[0].step_error, measured.methods[1].points[0].step_error);
}

TEST(ExactSteps, AreLeftOutWhereTimeIsOver) {
  Measured measured;
  std::vector<WorkPoint>&implicit = measured.methods[0].points, &newton = measured.methods[1].points;
  int asked = 0;
  // Enough for the cheapest, which newton-euler took no time for, and not for the others.
  newton[1].seconds_a_step = 1;
  newton[2].seconds_a_step = 1;
  tell_errors_apart(measured.methods, measured.ends, measured.system, measured.trusted,
                    [&] { return implicit[0].step_error && ++asked > 2; });
  for (const std::vector<WorkPoint>& points : {implicit, newton}) {
    EXPECT_TRUE(points[0].step_error);
    EXPECT_FALSE(points[1].step_error);
    EXPECT_FALSE(points[2].step_error);
  }
}

StepMaker reference_of(const System& system, std::string_view integrator) {
  return [&system, &row = *find_integrator(integrator)](double dt_s) {
    return make_reference(system, row, dt_s);
  };
}

StepSearch search_from(double first_s) {
  return {
      .first_s = first_s, .longest_s = 100 * first_s, .shortest_s = first_s / 64, .span_s = 2000 * first_s};
}

TEST(StableStep, OfAnOscillatorIsTheKnownLimit) {
  const System system = fast_and_slow_oscillator();
  const double omega = oscillator_frequency(system);
  struct Known {
    std::string_view integrator;
    double limit;
  };
  for (const Known& known : {Known{"semi-euler", 2}, Known{"verlet", 2}, Known{"rk4", 2 * std::sqrt(2.0)}})
    for (const double first : {0.3, 1.0, 3.0}) {  // from below and from above
      const StableStep found = largest_stable_step(system, reference_of(system, known.integrator),
                                                   search_from(first * known.limit / omega));
      EXPECT_LE(found.stable_s, known.limit / omega * 1.0001) << known.integrator << ' ' << first;
      EXPECT_GE(found.stable_s * step_resolution * step_resolution, known.limit / omega)
          << known.integrator << ' ' << first;
      EXPECT_LE(found.unstable_s, step_resolution * found.stable_s) << known.integrator << ' ' << first;
      EXPECT_TRUE(found.finished);
    }
}

TEST(StableStep, OfExplicitEulerIsNoneWithoutDamping) {
  const System system = fast_and_slow_oscillator();
  const StableStep found = largest_stable_step(system, reference_of(system, "explicit-euler"),
                                               search_from(2 / oscillator_frequency(system)));
  EXPECT_EQ(found.stable_s, 0);
  EXPECT_GT(found.unstable_s, 0);
}

TEST(StableStep, OfExplicitEulerWithDampingIsTheDampingOverTheStiffness) {
  System system = spring_oscillator();
  system.materials[0].damping = 0.002;
  // x'' = -k x - c x' is stable under Euler's method up to dt = c / k where it oscillates.
  const double limit = 0.002 / 200;
  const StableStep found =
      largest_stable_step(system, reference_of(system, "explicit-euler"), search_from(3 * limit));
  EXPECT_NEAR(found.stable_s / limit, 1, 0.03);
}

TEST(StableStep, OfASmallClothIsThatOfItsSpectrum) {
  const System system = cloth_system(10, 10);
  const Spectrum spectrum = spectrum_at(system, system.start);
  for (const std::string_view name : {"semi-euler", "rk4"}) {
    const Integrator& integrator = *find_integrator(name);
    const StepTheory theory = step_theory(integrator, system, spectrum, spectrum);
    const StableStep found =
        largest_stable_step(system, reference_of(system, name), search_from(theory.bound_s));
    EXPECT_NEAR(found.stable_s / theory.at_start_s, 1, 0.05) << name;
    EXPECT_LT(theory.bound_s, theory.at_start_s) << name;
    EXPECT_EQ(why_they_differ(integrator, found, theory, false), "") << name;
  }
}

TEST(StableStep, IsSearchedForNoFartherThanAsked) {
  const System system = fast_and_slow_oscillator();
  const double limit = 2 / oscillator_frequency(system);
  StepSearch search = search_from(0.1 * limit);
  search.longest_s = 0.2 * limit;
  const StableStep found = largest_stable_step(system, reference_of(system, "semi-euler"), search);
  EXPECT_EQ(found.stable_s, search.longest_s);
  EXPECT_EQ(found.unstable_s, 0);
}

TEST(StableStep, SaysThatItsSearchWasStopped) {
  const System system = spring_oscillator();
  StepSearch search = search_from(0.1 / oscillator_frequency(system));
  search.stop = [] { return true; };
  const StableStep found = largest_stable_step(system, reference_of(system, "semi-euler"), search);
  EXPECT_FALSE(found.finished);
  EXPECT_EQ(found.runs, 1);
}

TEST(StableStep, EndsInAHurryWithABracket) {
  const System system = fast_and_slow_oscillator();
  const double limit = 2 / oscillator_frequency(system);
  StepSearch search = search_from(0.3 * limit);
  search.hurry = [] { return true; };
  const StableStep found = largest_stable_step(system, reference_of(system, "semi-euler"), search);
  EXPECT_FALSE(found.finished);
  EXPECT_GT(found.stable_s, 0);
  EXPECT_LE(found.stable_s, limit * 1.0001);
  EXPECT_GE(found.unstable_s, limit);
}

StepLimit found_limit(std::string_view integrator, const System& system, const BackendInfo& backend) {
  const Spectrum spectrum = spectrum_at(system, system.start);
  const LimitRequest request{.system = &system,
                             .backends = {&backend},
                             .execution = {},
                             .at_start = spectrum,
                             .on_the_way = spectrum,
                             .seconds = 1000};
  return find_step_limit(*find_integrator(integrator), request);
}

/// A cloth without pins that hangs a row above the floor, or high above it.
StepLimit limit_of_backward_euler(double ceiling_m) {
  return found_limit("newton-euler", cloth_system(10, 10, ceiling_m, {}), *find_backend("serial"));
}

TEST(StepLimit, OfBackwardEulerIsTheFloors) {
  const StepLimit near = limit_of_backward_euler(0.1);
  EXPECT_GT(near.measured.unstable_s, 0);
  EXPECT_TRUE(near.floor_is_why);
  EXPECT_EQ(near.why.substr(0, 9), "the floor");
  const StepLimit high = limit_of_backward_euler(20);
  EXPECT_EQ(high.measured.unstable_s, 0);
  EXPECT_FALSE(high.floor_is_why);
  EXPECT_EQ(high.why, "");
}

TEST(StepLimit, IsNotTheFloorsIfEnergyGrowsInTheAir) {
  System system = cloth_system(10, 10);
  system.floor.height = -1000;
  const StepLimit limit = found_limit("xpbd", system, *find_backend("serial"));
  ASSERT_GT(limit.measured.unstable_s, 0);
  EXPECT_FALSE(limit.floor_is_why);
  EXPECT_THAT(limit.why, AllOf(Not(IsEmpty()), Not(StartsWith("the floor"))));
}

TEST(StepLimit, IsNoneOnABackendThatIsNeverStable) {
  const StepLimit failed = found_limit("semi-euler", cloth_system(4, 4), astray);
  EXPECT_EQ(failed.lack(), Lack::failed);
  EXPECT_THAT(failed.ending.status(),
              StartsWith("failed: its energy grows or is not finite even with a step of "));
  // Here the integrator is never stable.
  const StepLimit unstable =
      found_limit("explicit-euler", undamped(cloth_system(4, 4)), *find_backend("serial"));
  EXPECT_EQ(unstable.lack(), Lack::stable_step);
  EXPECT_EQ(unstable.ending.status(), "");
}

TEST(StepTheory, SaysWhyAMeasuredStepIsAnotherOne) {
  const Integrator& euler = *find_integrator("semi-euler");
  const StepTheory theory{.at_start_s = 1, .on_the_way_s = 1, .bound_s = 0.5};
  const auto measured = [](double stable) {
    return StableStep{.stable_s = stable, .unstable_s = 1.01 * stable};
  };
  // Within a tenth up, or down by the same factor: 1 / 1.1 = 0.9091.
  EXPECT_EQ(why_they_differ(euler, measured(1.099), theory, false), "");
  EXPECT_EQ(why_they_differ(euler, measured(0.91), theory, false), "");
  EXPECT_NE(why_they_differ(euler, measured(1.101), theory, false), "");
  EXPECT_NE(why_they_differ(euler, measured(0.909), theory, false), "");
  EXPECT_THAT(why_they_differ(euler, measured(1.5), theory, false), HasSubstr("longer"));
  EXPECT_THAT(why_they_differ(euler, measured(0.5), theory, false), HasSubstr("shorter"));
  EXPECT_THAT(why_they_differ(euler, measured(0.5), theory, true), HasSubstr("floor"));
  EXPECT_NE(why_they_differ(euler, {}, theory, false), "");
  EXPECT_NE(why_they_differ(euler, measured(1), {}, false), "");
  EXPECT_EQ(why_they_differ(euler, {}, {}, false), "");
}

}  // namespace
}  // namespace mssim
