// A check that could not fail would be none: backends that are wrong on purpose must be found.
#include "bench/verification/verification.h"

#include <iterator>

#include "backends/backends.h"
#include "backends/openmp/openmp.h"
#include "backends/spring_list/list_backends.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "platform/process.h"
#include "scene/scene_file.h"
#include "tests/support/files_fixture.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

struct Mistake {
  std::string name;
  std::function<void(System&)> make;
};

/// What a wrong backend might do, as a changed system that a right backend steps.
const std::vector<Mistake> mistakes{
    {"spring damping left out",
     [](System& s) {
       for (SpringMaterial& m : s.materials) m.damping = 0;
     }},
    {"stiffness of one kind 1 % off", [](System& s) { s.materials[shear].stiffness *= 1.01; }},
    {"bending springs left out",
     [](System& s) {
       s.materials[bending] = {0, 0};
     }},
    {"one spring in the middle missing", [](System& s) { s.springs.erase(s.springs.begin() + 6 * 275); }},
    {"one border spring missing", [](System& s) { s.springs.pop_back(); }},
    {"one pin forgotten", [](System& s) { s.pins.pop_back(); }},
    {"no gravity", [](System& s) { s.gravity = 0; }},
    {"mass 1 % off",
     [](System& s) {
       for (double& mass : s.node_mass) mass *= 1.01;
     }},
};

/// Near the origin, where positions are rounded least.
System low_cloth() { return cloth_system(20, 25, 0.2); }

TEST(Verification, PassesARightBackend) {
  const System system = low_cloth();
  const Reference reference = run_reference(system, integrators[0], backend_dt_s);
  const auto backend = make_serial(system, integrators[0], backend_dt_s, {});
  const Verification verification = verify(*backend, system, reference, backend_dt_s);
  EXPECT_FALSE(verification.failure) << *verification.failure;
  EXPECT_GT(verification.position_error, 0) << "single precision cannot be exact";
  EXPECT_LT(verification.position_error, reference.tolerance);
  EXPECT_EQ(verification.state_hash, state_hash(backend->state()));
}

TEST(Verification, PassesRightBackendsWhereRoundingsAddUp) {
  // Far up, and with short steps, a step moves a node by few units in its last place: roundings have one
  // sign.
  for (const auto& [height_m, step_s] : {std::pair{2., 5e-5}, {10., 5e-5}, {100., 5e-5}, {0.2, 1e-6}}) {
    const System system = cloth_system(20, 25, height_m);
    double furthest = 0;  // in tolerances of independent roundings
    for (const char* name : {"semi-euler", "midpoint", "rk4"}) {
      const Integrator& integrator = *find_integrator(name);
      const Reference reference = run_reference(system, integrator, step_s);
      for (const auto& make : {make_serial, make_openmp}) {
        const Verification found =
            verify(*make(system, integrator, step_s, {2, ""}), system, reference, step_s);
        EXPECT_EQ(found.failure, std::nullopt) << name << " at " << height_m << " m";
        furthest = std::max(furthest, found.position_error.value() / reference.tolerance);
      }
      if (height_m != 2) continue;
      System wrong = system;
      wrong.gravity *= 1.5;
      EXPECT_TRUE(verify(*make_serial(wrong, integrator, step_s, {}), system, reference, step_s).failure)
          << name;
    }
    EXPECT_GT(furthest, 1) << height_m << " m: independent roundings explain this, so it tests nothing";
  }
}

TEST(Verification, RefusesScenesSoFarAwayThatItWouldShowNothing) {
  const Reference reference = run_reference(cloth_system(20, 25, 1e4), integrators[0], backend_dt_s);
  ASSERT_TRUE(reference.failure);
  for (const char* part : {"nothing can be verified", "100 steps", "nearer to the origin"})
    EXPECT_THAT(*reference.failure, HasSubstr(part));
}

TEST(Verification, AllowsXpbdTheDriftOfItsSmallSteps) {
  SceneSpec spec = cloth_spec(5, 5);
  spec.solver.substeps = 1000;
  const System system = build_system(spec);
  const Integrator& xpbd = *find_integrator("xpbd");
  const Reference reference = run_reference(system, xpbd, 1e-3);
  const auto backend = make_backend(baseline_backend(), system, xpbd, 1e-3, {});
  const Verification found = verify(*backend, system, reference, 1e-3);
  EXPECT_EQ(found.failure, std::nullopt);
  EXPECT_GT(found.position_error.value(), position_tolerance(system, xpbd, reference.steps))
      << "it drifts less, so this tests nothing";
}

/// Expects a right backend to pass and each mistake to be found, with every integrator.
void expect_found(const std::vector<Mistake>& all, const System& system, double step_s) {
  for (const Integrator& integrator : integrators) {
    if (integrator.name == "explicit-euler") continue;  // grows at this step
    const Reference reference = run_reference(system, integrator, step_s);
    const auto verified = [&](const System& stepped) {
      return verify(*make_serial(stepped, integrator, step_s, {}), system, reference, step_s);
    };
    ASSERT_FALSE(verified(system).failure) << integrator.name;
    for (const Mistake& mistake : all) {
      System wrong = system;
      mistake.make(wrong);
      const Verification verification = verified(wrong);
      EXPECT_TRUE(verification.failure)
          << mistake.name << ", " << integrator.name << ": error " << verification.position_error.value_or(-1)
          << " of " << reference.tolerance;
    }
  }
}

TEST(Verification, FindsEveryMistake) { expect_found(mistakes, low_cloth(), backend_dt_s); }

const std::vector<Mistake> body_mistakes{
    {"spring damping left out", [](System& s) { s.materials[0].damping = 0; }},
    {"stiffness 1 % off", [](System& s) { s.materials[0].stiffness *= 1.01; }},
    {"one spring in the middle missing", [](System& s) { s.springs.erase(s.springs.begin() + 2000); }},
    {"the last spring missing", [](System& s) { s.springs.pop_back(); }},
    {"one rest length 1 % off", [](System& s) { s.springs[1000].rest_length *= 1.01F; }},
    {"no gravity", [](System& s) { s.gravity = 0; }},
    {"mass 1 % off",
     [](System& s) {
       for (double& mass : s.node_mass) mass *= 1.01;
     }},
};

TEST(Verification, FindsEveryMistakeWithABodyOfThePaper) {
  const SceneSpec spec = find_scene("box-small");
  ASSERT_TRUE(spec.dt_s);
  expect_found(body_mistakes, build_system(spec), *spec.dt_s);
}

struct Fault {
  std::string name;
  std::function<void(System&)> make = [](System& /*system*/) {};
  double step = 1;    ///< in steps of the scene
  bool lags = false;  ///< the node in the middle always is where it was a step before
};

/// What a wrong program may do, in one small thing.
const std::vector<Fault> faults{
    {"one bending spring missing",
     [](System& s) {
       const auto last =
           std::ranges::find(s.springs.rbegin(), s.springs.rend(), std::uint32_t{bending}, &Spring::kind);
       s.springs.erase(std::next(last).base());
     }},
    {"bending springs 1 % too stiff", [](System& s) { s.materials[bending].stiffness *= 1.01; }},
    {"shear springs 1 % too stiff", [](System& s) { s.materials[shear].stiffness *= 1.01; }},
    {"all springs 0.1 % too stiff",
     [](System& s) {
       for (SpringMaterial& m : s.materials) m.stiffness *= 1.001;
     }},
    {"no damping by the air", [](System& s) { s.viscous_damping = 0; }},
    {"damping by the air doubled", [](System& s) { s.viscous_damping *= 2; }},
    {"one node 1 % too heavy", [](System& s) { s.node_mass[s.nodes() / 2] *= 1.01; }},
    {"gravity 1 % too strong", [](System& s) { s.gravity *= 1.01; }},
    {.name = "steps 0.1 % too long", .step = 1.001},
    {.name = "one node a step late", .lags = true},
    {"no floor", [](System& s) { s.floor.height = -1e3; }},
    {"no friction", [](System& s) { s.floor.friction = 0; }},
    {"friction 5 % too strong", [](System& s) { s.floor.friction *= 1.05; }},
};

/// How far, in tolerances, a backend with the fault ends from where it should.
double distance_with(const Fault& fault, const System& system, double step_s, int steps, const State& right,
                     double tolerance) {
  System wrong = system;
  fault.make(wrong);
  const auto backend = make_serial(wrong, integrators[0], fault.step * step_s, {});
  const std::size_t late = wrong.nodes() / 2;
  for (int step = 0; step < steps; ++step) {
    const State before = fault.lags ? backend->state() : State{};
    backend->step(1);
    if (!fault.lags) continue;
    State state = backend->state();
    state.position[late] = before.position[late];
    state.velocity[late] = before.velocity[late];
    backend->set_state(state);
  }
  return position_deviation(system, right, backend->state()) / tolerance;
}

TEST(Verification, FindsTheFaultsThatTheDocumentationSaysItFinds) {
  std::ostringstream table;
  table << "| fault | on cloth2500 | on cloth40k | in the second stretch |\n|---|---|---|---|\n";
  std::vector<System> scenes;
  std::vector<Reference> references;
  const double step_s = *find_scene("cloth2500").dt_s;
  for (const char* name : {"cloth2500", "cloth40k"})
    references.push_back(
        run_reference(scenes.emplace_back(build_system(find_scene(name))), integrators[0], step_s));
  const SecondStretch second = run_second_stretch(scenes[1], integrators[0], step_s);
  for (const Fault& fault : faults) {
    table << "| " << fault.name << " |";
    for (std::size_t i = 0; i < scenes.size(); ++i)
      table << (distance_with(fault, scenes[i], step_s, references[i].steps, references[i].state,
                              references[i].tolerance) > 1
                    ? " found |"
                    : " - |");
    const double distance =
        distance_with(fault, second.system, step_s, second.steps, second.state, second.tolerance);
    EXPECT_GT(distance, 5) << fault.name;
    table << (distance > 1 ? " found |" : " - |") << '\n';
  }
  const std::string page = read_file(source_file("docs/verification.md"));
  EXPECT_NE(page.find(table.str()), std::string::npos) << "docs/verification.md should have\n" << table.str();
}

TEST(SecondStretch, MeetsTheFloorAndPassesRightBackends) {
  const System cloth = build_system(find_scene("cloth2500")), body = build_system(find_scene("box-small"));
  for (const System* scene : {&cloth, &body})
    for (const Integrator& integrator : integrators) {
      const SecondStretch second = run_second_stretch(*scene, integrator, 5e-5);
      EXPECT_GT(second.landed, 3U) << integrator.name << " in " << second.steps << " steps";
      for (const auto& make : {make_serial, make_openmp}) {
        const auto backend = make(second.system, integrator, 5e-5, {2, ""});
        EXPECT_EQ(verify_second(*backend, second), std::nullopt) << integrator.name;
      }
    }
  const SecondStretch second = run_second_stretch(body, integrators[0], 5e-5);
  for (const Fault& fault : faults) {
    if (fault.name.find("bending") != std::string::npos || fault.name.find("shear") != std::string::npos)
      continue;
    EXPECT_GT(distance_with(fault, second.system, 5e-5, second.steps, second.state, second.tolerance), 5)
        << fault.name;
  }
}

/// Two nodes of 1 kg, 1 m above each other, and between them a spring of no stiffness that is 2 m long at
/// rest.
System two_nodes() {
  System system;
  system.topology = TetrahedralMesh{};
  system.springs = {{0, 1, 2, 0}};
  system.materials = {{0, 0}};
  system.node_mass = {1, 1};
  system.gravity = 10;
  system.start.position = {{0, 0, 0}, {0, 1, 0}};
  system.start.velocity.resize(2);
  return system;
}

TEST(PositionTolerance, IsFourTimesTheRandomWalkOfRoundings) {
  System system = two_nodes();
  system.start.position[1].z = -3;
  // Of |x| = 3 m in rest lengths of 2 m, after 100 steps that round once: 4 sqrt(100) 2^-24 3 / 2.
  EXPECT_DOUBLE_EQ(position_tolerance(system, *find_integrator("semi-euler"), 100), 60 * 0x1p-24);
  EXPECT_DOUBLE_EQ(position_tolerance(system, *find_integrator("newton-euler"), 100), 60 * 0x1p-24);
  EXPECT_DOUBLE_EQ(position_tolerance(system, *find_integrator("semi-euler"), 25), 30 * 0x1p-24);
  // rk4 writes the position in each of its four stages.
  EXPECT_DOUBLE_EQ(position_tolerance(system, *find_integrator("rk4"), 100), 120 * 0x1p-24);
}

TEST(PositionTolerance, IsFarAboveTheErrorsOfXpbdInSinglePrecision) {
  // Gravity and air damping change a velocity by a few units in the last place per substep.
  const Integrator& xpbd = *find_integrator("xpbd");
  constexpr int steps = 1000;
  for (const char* scene : {"torus-small", "box-small"}) {
    const SceneSpec spec = find_scene(scene);
    const System system = build_system(spec);
    const auto in_double = make_reference(system, xpbd, *spec.dt_s),
               in_single = make_backend(best_host_backend(), system, xpbd, *spec.dt_s, {});
    in_double->step(steps);
    in_single->step(steps);
    EXPECT_LT(position_deviation(system, in_double->state(), in_single->state()),
              position_tolerance(system, xpbd, steps) / 50)
        << scene;
  }
}

TEST(Deviation, IsInRestLengthsAndOverWhatIsKineticAndElastic) {
  const System system = two_nodes();
  State state = system.start;
  state.position[1] += Vec3d{0.3, 0, 0.4};  // 0.5 m of 2 m
  state.velocity[0] = {3, 0, 0};            // 4.5 J, beside 10 J of weight
  const Deviation deviation =
      deviation_from(system, system.start, {.kinetic = 3, .elastic = 1, .gravitational = 10}, state);
  EXPECT_NEAR(deviation.position, 0.25, 1e-15);
  EXPECT_NEAR(deviation.energy, (14.5 - 14) / 4, 1e-15);
}

TEST(Verification, FailsWhereTheEnergyIsOffByMoreThanAHundredth) {
  const System system = low_cloth();
  Reference reference = run_reference(system, integrators[0], backend_dt_s);
  reference.tolerance = 1;
  const double moving = reference.energy.kinetic + reference.energy.elastic,
               weight = reference.energy.gravitational;
  for (const double off : {-0.0105, -0.0095, 0.0095, 0.0105}) {
    reference.energy.gravitational = weight - off * moving;
    const auto backend = make_serial(system, integrators[0], backend_dt_s, {});
    const Verification verification = verify(*backend, system, reference, backend_dt_s);
    EXPECT_NEAR(verification.energy_drift.value(), off, 2e-4);
    EXPECT_EQ(verification.failure.has_value(), std::abs(off) > 0.01) << off;
  }
}

/// Ends of samples of `stepped`, which all start from `start`, after as many steps.
std::vector<SampleEnd> ends_of(const System& stepped, const State& start, const std::vector<int>& steps) {
  const auto backend = make_serial(stepped, integrators[0], backend_dt_s, {});
  std::vector<SampleEnd> ends;
  for (const int count : steps) {
    backend->set_state(start);
    backend->step(count);
    ends.push_back(sample_end(stepped, backend->state(), count, 0));
  }
  return ends;
}

TEST(SampleCheck, AllowsWhatFoldsMakeOfRoundingsAndNoMore) {
  System cloth = low_cloth();
  for (Vec3d& x : cloth.start.position) x.x *= 0.9;  // pressed from the sides, it folds
  const State start = sample_start(cloth, 7);
  std::vector<SampleEnd> ends = ends_of(cloth, start, {40, 20, 40});
  const auto reference = make_reference(cloth, integrators[0], backend_dt_s);
  reference->set_state(start);
  reference->step(40);
  const State end = reference->state();
  EXPECT_GT(position_deviation(cloth, end, {ends[0].positions, end.velocity}),
            position_tolerance(cloth, integrators[0], 40))
      << "folds enlarge roundings beyond the random walk, or this tests nothing";
  ends[2].positions[240].y += 0.01 * mean_rest_length(cloth);
  const std::vector<std::string> reasons = check_samples(cloth, integrators[0], backend_dt_s, start, 0, ends);
  EXPECT_EQ(reasons[0], "");
  EXPECT_EQ(reasons[1], "");
  EXPECT_THAT(reasons[2], HasSubstr("position error"));
}

/// A narrow cloth that swings down and folds.
System narrow_cloth() {
  SceneSpec spec = find_scene("cloth2500");
  auto& cloth = std::get<ClothSpec>(spec.content);
  cloth.rows = 64;
  cloth.columns = 7;
  return build_system(spec);
}

// Roundings of the positions that Verlet's stages see are not those of the state's positions: a reference
// that rounded the latter came 5.6 times less far than openmp here.
TEST(SampleCheck, RoundsThePositionsThatAreStepped) {
  constexpr double step_s = 5e-5;
  constexpr int steps = 1000;
  const System cloth = narrow_cloth();
  for (const std::uint32_t number : {1U, 40U}) {
    const State start = sample_start(cloth, number);
    const auto backend = make_backend(best_host_backend(), cloth, verlet, step_s, {1, ""});
    backend->set_state(start);
    backend->step(steps);
    const SampleEnd end = sample_end(cloth, backend->state(), steps, 0);
    EXPECT_THAT(check_samples(cloth, verlet, step_s, start, 0, {&end, 1}), testing::ElementsAre(""));
  }
}

// From this start the rounded reference happens to come a third as far as one whose start is displaced.
TEST(SampleCheck, RoundsTheReferenceAgainIfItCameNearByChance) {
  constexpr double step_s = 5e-5;
  constexpr int steps = 600;
  const System cloth = narrow_cloth();
  const Integrator& midpoint = *find_integrator("midpoint");
  const State start = sample_start(cloth, 448);
  State states[2];
  for (int i = 0; i < 2; ++i) {
    const auto backend = i == 0 ? make_reference(cloth, midpoint, step_s)
                                : make_backend(baseline_backend(), cloth, midpoint, step_s, {1, ""});
    backend->set_state(start);
    backend->step(steps);
    states[i] = backend->state();
  }
  std::vector<SampleEnd> ends;
  for (const double times : {1.0, 3.0, 10.0}) {
    SampleEnd& end = ends.emplace_back(sample_end(cloth, states[1], steps, 0));
    for (std::size_t node = 0; node < cloth.nodes(); ++node) {
      const Vec3d& expected = states[0].position[node];
      end.positions[node] = expected + times * (states[1].position[node] - expected);
    }
  }
  EXPECT_THAT(check_samples(cloth, midpoint, step_s, start, 0, ends),
              testing::ElementsAre("", "", HasSubstr("position error")));
}

TEST(SampleCheck, FindsASampleThatIsWrongAtItsEnd) {
  const System cloth = low_cloth();
  const State start = sample_start(cloth, 7);
  std::vector<SampleEnd> ends = ends_of(cloth, start, {100, 100, 100, 300});
  ends[1].positions[40].z += 1e-4;
  ends[2].energy_j *= 1.1;
  const std::vector<std::string> reasons = check_samples(cloth, integrators[0], backend_dt_s, start, 0, ends);
  ASSERT_EQ(reasons.size(), 4U);
  EXPECT_EQ(reasons[0], "");
  EXPECT_THAT(reasons[1], HasSubstr("position error"));
  EXPECT_THAT(reasons[2], HasSubstr("energy"));
  EXPECT_EQ(reasons[3], "");
}

TEST(Verification, StopsBeforeTheFloor) {
  const System system = cloth_system(8, 8, 0.0015);
  const Reference reference = run_reference(system, integrators[0], backend_dt_s);
  EXPECT_FALSE(reference.failure);
  EXPECT_GT(reference.steps, 0);
  EXPECT_LT(reference.steps, verification_steps);
  for (const Vec3d& x : reference.state.position) EXPECT_GT(x.y, system.floor.height);
}

/// A flat sheet without springs' work that reaches the floor, up to rounding, in step `landing` and bounces
/// off.
System bouncing_sheet(int landing, double step_s) {
  SceneSpec spec = sheet_spec(3, 3, 10 * step_s * step_s * landing * (landing + 1) / 2);
  spec.gravity_m_per_s2 = 10;
  spec.viscous_damping_per_s = 0;
  spec.floor = {0, 1, 0};
  return build_system(spec);
}

TEST(Verification, StopsBeforeTheFloorThoughNodesBounceOffBetweenTwoLooks) {
  constexpr double step_s = 1e-4;
  for (const int landing : {23, 25, 31, 35, 37}) {
    const System system = bouncing_sheet(landing, step_s);
    const Reference reference = run_reference(system, integrators[0], step_s);
    EXPECT_FALSE(reference.failure) << *reference.failure;
    EXPECT_GE(reference.steps, landing - 1);
    EXPECT_LE(reference.steps, landing);
    for (const auto& make : {make_serial, make_openmp})
      EXPECT_EQ(verify(*make(system, integrators[0], step_s, {2, ""}), system, reference, step_s).failure,
                std::nullopt)
          << landing;
  }
}

TEST(SampleCheck, AllowsLandingsAtOtherTimes) {
  constexpr double step_s = 1e-4;
  constexpr int steps = 2000;
  System system = cloth_system(2, 2, 0.01, {});
  system.floor = {0, 1, 0};
  for (std::uint32_t number = 1; number <= 8; ++number) {
    const State start = sample_start(system, number);
    for (const auto& make : {make_serial, make_openmp}) {
      const auto backend = make(system, integrators[0], step_s, {1, ""});
      backend->set_state(start);
      backend->step(steps);
      const std::vector<SampleEnd> ends{sample_end(system, backend->state(), steps, 0)};
      EXPECT_THAT(check_samples(system, integrators[0], step_s, start, 0, ends), testing::ElementsAre(""))
          << number;
    }
  }
}

TEST(BlowUp, IsFoundAtTheFirstBadStepAndNode) {
  const System system = cloth_system(10, 10);
  const double too_long = 20 * backend_dt_s;
  const int steps = 100;
  int first_bad = 0;
  const auto slow = make_openmp(system, integrators[0], too_long, {1, ""});
  while (first_bad < steps && !first_bad_node(slow->state())) {
    slow->step(1);
    ++first_bad;
  }
  ASSERT_LT(first_bad, steps) << "this dt must be too long";

  const auto backend = make_openmp(system, integrators[0], too_long, {2, ""});
  const auto blow_up = find_blow_up(*backend, system.start, steps);
  ASSERT_TRUE(blow_up);
  EXPECT_EQ(blow_up->step, first_bad);
  EXPECT_EQ(blow_up->node, *first_bad_node(slow->state()));
  const std::string text = describe(*blow_up, too_long);
  EXPECT_THAT(text, HasSubstr("step " + std::to_string(first_bad)));
  EXPECT_THAT(text, HasSubstr("node " + std::to_string(blow_up->node)));
}

TEST(Reference, EndsWhenTheUserEndsTheProgram) {
  note_ending_signal(SIGINT);
  EXPECT_THROW(run_reference(cloth_system(4, 4), *find_integrator("rk4"), 1e-3), Interrupted);
  EXPECT_EQ(take_ending_signal(), SIGINT) << "the references beside it are to see it, too";
}

TEST(BlowUp, OfTheReferenceFailsEveryRow) {
  const System system = cloth_system(10, 10);
  const Reference reference = run_reference(system, integrators[0], 50 * backend_dt_s);
  ASSERT_TRUE(reference.failure);
  EXPECT_THAT(*reference.failure, HasSubstr("blew up at step"));
  const auto backend = make_serial(system, integrators[0], 50 * backend_dt_s, {});
  const Verification found = verify(*backend, system, reference, 50 * backend_dt_s);
  EXPECT_EQ(found.failure, reference.failure);
  EXPECT_FALSE(found.position_error || found.energy_drift) << "nothing was compared";
}

}  // namespace
}  // namespace mssim
