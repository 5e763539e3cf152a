// Algorithm 1 on an OpenCL device: the reference but for rounding, whatever shares the work.

#include "garment/stepping/dressing_backend.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "tests/support/backend_checks.h"
#include "tests/support/dressing_systems.h"
#include "tests/support/garment_system.h"
#include "tests/support/opencl_variants.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

std::unique_ptr<DressingBackend> make(const System& system, const DressingShape& shape) {
  return make_opencl_dressing(system, semi_euler, dressing_dt_s, first_opencl_device(), DeviceMemory::shared,
                              shape);
}

/// What a CPU runs, and what GPUs would, with groups that are smaller than a row, do not divide one, and are
/// larger.
std::vector<DressingShape> shapes() {
  std::vector<DressingShape> all{{1, 1}, {1, 7}, {1, 64}};
  for (const int lanes : opencl_lanes)
    if (lanes > 1) all.push_back({lanes, 1});
  return all;
}

std::string name_of(const DressingShape& shape) {
  return std::to_string(shape.lanes) + "_lanes_" + std::to_string(shape.items) + "_items";
}

class OpenclDressingOf : public testing::TestWithParam<DressingShape> {};

INSTANTIATE_TEST_SUITE_P(OfEachShape, OpenclDressingOf, testing::ValuesIn(shapes()),
                         [](const auto& test) { return name_of(test.param); });

/// The state after these calls of step().
State after(Backend& backend, const State& start, const std::vector<int>& calls) {
  backend.set_state(start);
  for (const int steps : calls) backend.step(steps);
  return backend.state();
}

void expect_same_progress(const DressingBackend& a, const DressingBackend& b) {
  EXPECT_EQ(a.progress().open_joints, b.progress().open_joints);
  EXPECT_EQ(a.progress().draping, b.progress().draping);
  EXPECT_EQ(a.progress().seamed_at, b.progress().seamed_at);
}

/// Of the sack, which hangs on the ball by friction once it drapes.
constexpr int seaming_steps = 100;
System soon_closed_sack() {
  System system = sack_around_a_ball();
  garment_in(system).dressing.longest_seaming_s = (seaming_steps + 0.5) * dressing_dt_s;
  return system;
}

TEST_P(OpenclDressingOf, SeamsAndDrapesAroundABallLikeTheReference) {
  const System system = soon_closed_sack();
  const auto device = make(system, GetParam());
  const auto reference = reference_dressing(system);
  const auto step = [&](int count) {
    const double distance = distance_after(count, *device, *reference);
    expect_same_progress(*device, *reference);
    return distance;
  };
  EXPECT_EQ(device->progress().open_joints, 71U);
  // A step rounds positions of up to 0.3 m by 1.5e-8 m, and springs swing with what they are given.
  EXPECT_LT(step(seaming_steps), 3e-6);
  EXPECT_FALSE(device->progress().draping);
  EXPECT_LT(step(1), 3e-6);
  EXPECT_EQ(device->progress().seamed_at, seaming_steps + 1);
  // A node that rounding carries to the body's plane a step later is caught a step's way farther on: the
  // fastest move at 0.6 m/s.
  EXPECT_LT(step(100), dressing_dt_s * 0.6);
  const System untouched = [&] {
    System other = system;
    garment_in(other).body_maps.clear();
    return other;
  }();
  const State without = state_after(*reference_dressing(untouched), seaming_steps + 101);
  EXPECT_GT(largest_distance(without.position, reference->state().position), 1e-3)
      << "the ball is not touched";
}

TEST(OpenclDressing, GivesTheSameBitsWhateverSharesTheWorkAndHoweverStepsAreCutIntoCalls) {
  const System system = soon_closed_sack();
  const State expected = after(*make(system, shapes().back()), system.start, {150});
  for (const DressingShape& shape : shapes()) {
    const auto backend = make(system, shape);
    for (const auto& calls : {std::vector{150}, {1, 99, 1, 49}})
      EXPECT_TRUE(same_state(after(*backend, system.start, calls), expected)) << name_of(shape);
  }
  for (const DeviceInMemory& memory : ways_to_memory()) {
    const auto backend = make_opencl_dressing(system, semi_euler, dressing_dt_s, memory.device, memory.memory,
                                              shapes().back());
    EXPECT_EQ(after(*backend, system.start, {150}).position, expected.position) << memory.name;
  }
}

// Friction that holds what it touches leaves zeros of both signs, which == takes for the same.
TEST(OpenclDressing, GivesZerosTheSameSignWhateverSharesTheWork) {
  System system = soon_closed_sack();
  garment_in(system).dressing.friction = 100;
  const auto after_150 = [&](const DressingShape& shape) {
    return after(*make(system, shape), system.start, {150});
  };
  const State expected = after_150(shapes().back());
  EXPECT_TRUE(std::ranges::any_of(expected.velocity, [](const Vec3d& v) { return v == Vec3d{}; }))
      << "friction holds nothing";
  for (const DressingShape& shape : shapes())
    EXPECT_EQ(state_hash(after_150(shape)), state_hash(expected)) << name_of(shape);
}

TEST(OpenclDressing, CorrectsInEverySweepAsSerialDoes) {
  std::vector<Vec3d> before;
  for (const std::uint32_t sweeps : {0U, 1U, 2U, 3U, 4U}) {
    System system = stretched_sheets();
    garment_in(system).dressing.correction_sweeps = sweeps;
    State stretched = system.start;  // every spring beyond its limit
    for (Vec3d& x : stretched.position) x = 1.1 * x;
    round_to_single(stretched);
    const auto soon_after = [&](Backend& backend) {
      return after(backend, stretched, {1}).velocity;  // in one step both judge the same lengths by the limit
    };
    const auto single = serial_dressing(system);
    const std::vector<Vec3d> expected = soon_after(*single);
    // m/s. Another order of corrections within a block makes more than 0.5, rounding some 1e-6.
    for (const DressingShape& shape : {DressingShape{1, 7}, shapes().back()}) {
      EXPECT_LT(largest_distance(soon_after(*make(system, shape)), expected), 2e-5)
          << sweeps << " sweeps, " << name_of(shape);
    }
    if (sweeps > 0) {
      EXPECT_GT(largest_distance(before, expected), 1e-3) << sweeps << " sweeps";
    }
    before = expected;
  }
}

TEST(OpenclDressing, GoesOnFromADrapedStateAsIfItHadSewnItself) {
  const System system = stretched_sheets();
  expect_goes_on_when_draped(*make(system, shapes().back()), system);
}

TEST(OpenclDressing, HoldsUpperEdgesAsSerialDoes) {
  System system = soon_closed_sack();
  system.gravity = 9.81;
  garment_in(system).dressing.seaming_gravity = 1;
  garment_in(system).dressing.edge_held = true;
  const auto device = make(system, shapes().back());
  const auto serial = serial_dressing(system);
  for (const int steps : {seaming_steps, 20}) {
    EXPECT_LT(distance_after(steps, *device, *serial), 1e-5) << steps;
    expect_same_progress(*device, *serial);
    if (steps != seaming_steps) continue;
    for (const GarmentPanel& panel : garment_in(system).panels)
      for (std::uint32_t column = 0; column < panel.columns; ++column) {
        const std::uint32_t node = panel.node(panel.rows - 1, column);
        EXPECT_EQ(device->state().position[node].y, system.start.position[node].y) << panel.name;
      }
  }
}

TEST(OpenclDressing, DrapesAtOnceWhatHasNoSeams) {
  System system = garment_of({{20, 5, 0.01, {0, 0, 0}}});
  system.gravity = 9.81;
  const auto backend = make(system, shapes().back());
  EXPECT_TRUE(backend->progress().draping);
  backend->step(100);
  // Semi-implicit Euler falls dt^2 g n (n + 1) / 2.
  EXPECT_NEAR(backend->state().position[0].y, -9.81 * dressing_dt_s * dressing_dt_s * 100 * 101 / 2, 1e-6);
  EXPECT_EQ(backend->progress().seamed_at, 0);
}

TEST(OpenclDressing, RefusesWhatItCannotDo) {
  System system = two_squares();
  EXPECT_THROW(make_opencl_dressing(system, *find_integrator("rk4"), dressing_dt_s, first_opencl_device(),
                                    DeviceMemory::shared, {}),
               Unsupported);
  OpenclDevice small = first_opencl_device();
  small.global_memory_bytes = 1000;
  EXPECT_THROW(make_opencl_dressing(system, semi_euler, dressing_dt_s, small, DeviceMemory::shared, {}),
               Unsupported);
  garment_in(system).touching.emplace();
  EXPECT_THROW(make_backend(*find_backend("opencl"), system, semi_euler, dressing_dt_s, {.threads = 1}),
               Unsupported);
}

}  // namespace
}  // namespace mssim
