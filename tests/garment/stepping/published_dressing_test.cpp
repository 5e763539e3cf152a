// Algorithm 1 as printed: each loop beside mssim's own form of it, where the two agree.
#include "garment/stepping/published_dressing.h"

#include <span>

#include "backends/backends.h"
#include "garment/fitting/fitting.h"
#include "garment/stepping/dressing_backend.h"
#include "mesh/meshing.h"
#include "model/system.h"
#include "tests/support/backend_checks.h"
#include "tests/support/dressing_systems.h"
#include "tests/support/garment_system.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// Steps of two_squares in which no joint closes: a closed one is held in another way than `serial` does.
constexpr int steps_with_open_joints = 10;

/// How far apart the published loops and mssim's own form are after so many steps, both in double precision.
double distance_from_serial(const System& system, double dt_s, int steps, const State& start) {
  const auto published = make_published_reference(system, semi_euler, dt_s);
  const auto serial = reference_dressing(system, dt_s);
  for (Backend* backend : std::initializer_list<Backend*>{published.get(), serial.get()}) {
    backend->set_state(start);
    backend->step(steps);
  }
  EXPECT_GT(largest_distance(serial->state().position, start.position), 1e-6) << "nothing moves";
  return largest_distance(published->state().position, serial->state().position);
}

TEST(PublishedDressing, AddsForcesOfSpringsDampingGravityAndOpenJointsAsSerialDoes) {
  System system = two_squares();
  system.gravity = 9.81;
  garment_in(system).dressing.seaming_gravity = 0.5;
  garment_in(system).dressing.correction_threshold = 100;  // in loop 5 they differ
  for (std::size_t i = 0; i < system.nodes(); ++i)
    system.start.velocity[i] = {0.1 * std::sin(static_cast<double>(i)), 0.05, 0};
  EXPECT_LT(distance_from_serial(system, dressing_dt_s, steps_with_open_joints, system.start), 1e-12);
  // A node between the two ends of an edge.
  System strips = garment_of({{2, 3, 0.01, {0, 0.03, 0}}, {2, 2, 0.02, {0, 0, 0}, {1, 0, 0}, {0, -1, 0}}});
  const GarmentPanel& coarse = garment_in(strips).panels[1];
  garment_in(strips).joints = {{1, coarse.node(0, 0), coarse.node(0, 1), 0.3, 0.01, 1, 0}};
  EXPECT_LT(distance_from_serial(strips, dressing_dt_s, 20, strips.start), 1e-12);
  System one = garment_of({{10, 10, 0.01, {0, 0, 0}}});  // without joints it is draped from the first step on
  one.gravity = 9.81;
  one.viscous_damping = 16;
  one.pins = {90, 99};
  EXPECT_LT(distance_from_serial(one, dressing_dt_s, 100, one.start), 1e-12);
}

TEST(PublishedDressing, MeetsTheBodyByVelocityAsSerialDoesWithoutItsPush) {
  System system = garment_of({{21, 21, 0.02, {-0.2, 0.16, 0.2}, {1, 0, 0}, {0, 0, -1}}});
  system.gravity = 9.81;
  system.viscous_damping = 16;
  put_on(system, surface_of(SphereShape{0.15, 24}), {.offset = 0.003});
  DressingSettings& rules = garment_in(system).dressing;
  rules.push_speed = 0;
  rules.correction_threshold = 100;
  const double dt_s = 2.5e-4;
  EXPECT_LT(distance_from_serial(system, dt_s, 400, system.start), 1e-9);
  // Without the body the middle would have fallen by 44 mm less what is damped.
  const State state = state_after(*make_published_reference(system, semi_euler, dt_s), 400);
  EXPECT_GT(state.position[10 * 21 + 10].y, 0.15);
}

TEST(PublishedDressing, TakesFromTheEndsOfALongSpringWhatLengthensIt) {
  System system = garment_of({{1, 2, 0.01, {0, 0, 0}}});
  ASSERT_EQ(system.springs.size(), 1U);
  system.materials = {{1e-9, 0}, {1e-9, 0}, {1e-9, 0}};
  system.node_mass[1] *= 3;
  const auto after_a_step = [&](double length, double speed) {
    State state = system.start;
    state.position[1].x = state.position[0].x + length;
    state.velocity = {{-speed, 0.1, 0}, {speed, -0.2, 0.3}};
    const auto backend = make_published_reference(system, semi_euler, 1e-5);
    backend->set_state(state);
    backend->step(1);
    return backend->state();
  };
  const auto expect_along = [](const State& state, double first, double second) {
    EXPECT_NEAR(state.velocity[0].x, first, 1e-9);
    EXPECT_NEAR(state.velocity[1].x, second, 1e-9);
    EXPECT_NEAR(state.velocity[0].y, 0.1, 1e-9) << "across";
    EXPECT_NEAR(state.velocity[1].z, 0.3, 1e-9) << "across";
  };
  // 5 % longer is the threshold. Both go on as their common centre does, (-0.4 + 3 * 0.4) / 4.
  expect_along(after_a_step(0.0106, 0.4), 0.2, 0.2);
  expect_along(after_a_step(0.0104, 0.4), -0.4, 0.4);
  expect_along(after_a_step(0.0106, -0.4), 0.4, -0.4);
  garment_in(system).dressing.correction = VelocityCorrection::none;
  expect_along(after_a_step(0.0106, 0.4), -0.4, 0.4);
}

TEST(PublishedDressing, ClosesASeamAndHoldsItByASpring) {
  const System system = two_squares();
  const auto backend = maker_of(published_dressings.front())(system, semi_euler, dressing_dt_s, {});
  const DressingResult result = dress(*backend, system, dressing_dt_s, {}, always);
  ASSERT_TRUE(result.seamed_at);
  EXPECT_TRUE(result.settled);
  EXPECT_LT(fit_of(system, result.state.position, nobody()).largest_gap, 1e-4);
}

TEST(PublishedDressing, HasTheSameBitsInRegistersAndInThreads) {
  for (const System& system : {stretched_sheets(), sack_around_a_ball()}) {
    const auto stepped = [&](const PublishedDressing& dressing, int threads, int steps) {
      auto backend = maker_of(dressing)(system, semi_euler, dressing_dt_s, {.threads = threads});
      EXPECT_EQ(backend->threads(), dressing.parallel ? threads : 1);
      backend->step(steps);
      return backend;
    };
    // Three threads take long where two processors are: through the six loops, but not until it is draped.
    for (const auto& [threads, steps] : {std::pair(2, 1500), std::pair(3, 50)}) {
      const auto plain = stepped(published_dressings.front(), 1, steps);
      EXPECT_EQ(plain->progress().draping, steps == 1500);
      EXPECT_FALSE(first_bad_node(plain->state()));
      for (const PublishedDressing& dressing : std::span(published_dressings).subspan(1))
        EXPECT_TRUE(same_state(stepped(dressing, threads, steps)->state(), plain->state()))
            << dressing.name << ", " << threads;
    }
  }
}

TEST(PublishedDressing, IsTheReferenceButForRounding) {
  System system = two_squares();
  system.gravity = 9.81;
  const auto reference = make_published_reference(system, semi_euler, dressing_dt_s);
  reference->step(steps_with_open_joints);
  ASSERT_GT(reference->progress().open_joints, 0U);
  for (const PublishedDressing& dressing : published_dressings) {
    const State found = state_after(*maker_of(dressing)(system, semi_euler, dressing_dt_s, {.threads = 2}),
                                    steps_with_open_joints);
    EXPECT_LT(largest_distance(found.position, reference->state().position), 1e-6) << dressing.name;
  }
}

TEST(PublishedDressing, GoesOnFromADrapedStateAsIfItHadSewnItself) {
  const System system = stretched_sheets();
  expect_goes_on_when_draped(
      *maker_of(published_dressings.back())(system, semi_euler, dressing_dt_s, {.threads = 2}), system);
}

TEST(PublishedDressing, RefusesWhatThePaperDoesNotHave) {
  System system = two_squares();
  for (const BackendInfo& backend : garment_backends()) {
    const auto make = [&](const System& of, const Integrator& integrator) {
      return make_backend(backend, of, integrator, dressing_dt_s, {.threads = 1});
    };
    EXPECT_THROW(make(system, *find_integrator("rk4")), Unsupported) << backend.name;
    EXPECT_THROW(make(cloth_system(5, 5), semi_euler), Unsupported) << backend.name;
    System layered = system;
    garment_in(layered).touching.emplace();
    const std::string refusal = sentence_of<Unsupported>([&] { make(layered, semi_euler); });
    for (const char* remedy : {"serial", "openmp"}) EXPECT_THAT(refusal, HasSubstr(remedy)) << backend.name;
    EXPECT_NO_THROW(make(system, semi_euler)) << backend.name;
  }
}

}  // namespace
}  // namespace mssim
