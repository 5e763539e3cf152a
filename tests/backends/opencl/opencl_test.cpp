#include "backends/opencl/opencl.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "model/topology.h"
#include "tests/support/backend_step.h"
#include "tests/support/free_fall.h"
#include "tests/support/largest_distance.h"
#include "tests/support/opencl_variants.h"

namespace mssim {
namespace {

using ::testing::HasSubstr;

/// A cloth at rest in the plane y = height, spacing 2 cm.
System flat_cloth(std::uint32_t rows, std::uint32_t columns, double height) {
  System system;
  const GridPatch grid{rows, columns, 0.02};
  system.topology = grid;
  system.springs = springs_of(grid);
  system.materials = {{40, 0.02}, {20, 0.01}, {10, 0.005}};
  system.node_mass.assign(grid.nodes(), 4e-4);
  system.gravity = 9.81;
  system.floor.height = -100;
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) {
      system.start.position.push_back({0.02 * column, height, 0.02 * row});
      system.start.velocity.push_back({});
    }
  return system;
}

/// The same, rippled, moving, with air drag, and pinned at some nodes all over it, its last one too.
System rippled_cloth(std::uint32_t rows, std::uint32_t columns) {
  System system = flat_cloth(rows, columns, 0.5);
  system.viscous_damping = 0.3;
  const auto nodes = static_cast<std::uint32_t>(system.nodes());
  for (std::uint32_t node = 0; node < nodes; ++node) {
    system.start.position[node] +=
        {1e-3 * std::sin(node), 4e-3 * std::cos(0.7 * node), 1e-3 * std::sin(2.0 * node)};
    system.start.velocity[node] = {0.1 * std::cos(node), 0.2 * std::sin(0.3 * node), 0.1};
  }
  for (std::uint32_t node = 2; node + 1 < nodes; node += 17) system.pins.push_back(node);
  if (nodes > 1) system.pins.push_back(nodes - 1);
  for (const std::uint32_t pin : system.pins) system.start.velocity[pin] = {};
  round_to_single(system.start);
  return system;
}

/// Springs, drag and gravity in double, straight from Hooke's law.
std::vector<Vec3d> accelerations(const System& system, const State& state) {
  std::vector<Vec3d> a(system.nodes());
  for (const Spring& spring : system.springs) {
    const SpringMaterial& material = system.materials[spring.kind];
    const Vec3d d = state.position[spring.second] - state.position[spring.first];
    const Vec3d u = state.velocity[spring.second] - state.velocity[spring.first];
    const double length = std::sqrt(dot(d, d));
    const Vec3d direction = (1 / length) * d;
    const double force =
        material.stiffness * (length - double{spring.rest_length}) + material.damping * dot(u, direction);
    a[spring.first] += (force / system.node_mass[0]) * direction;
    a[spring.second] -= (force / system.node_mass[0]) * direction;
  }
  for (std::size_t node = 0; node < a.size(); ++node)
    a[node] += -system.viscous_damping * state.velocity[node] - Vec3d{0, system.gravity, 0};
  for (const std::uint32_t pin : system.pins) a[pin] = {};
  return a;
}

/// x + h v, v + h a
State moved(const State& from, double h, const std::vector<Vec3d>& v, const std::vector<Vec3d>& a) {
  State to = from;
  for (std::size_t node = 0; node < v.size(); ++node) {
    to.position[node] += h * v[node];
    to.velocity[node] += h * a[node];
  }
  return to;
}

/// One step of each method as the textbooks write it.
using Method = std::function<State(const System&, const State&, double dt)>;

State semi_euler(const System& system, const State& s, double dt) {
  const auto a = accelerations(system, s);
  return moved(s, dt, moved(s, dt, a, a).velocity, a);
}
State midpoint(const System& system, const State& s, double dt) {
  const State middle = moved(s, dt / 2, s.velocity, accelerations(system, s));
  return moved(s, dt, middle.velocity, accelerations(system, middle));
}
State rk4(const System& system, const State& s, double dt) {
  const auto a1 = accelerations(system, s);
  const State s2 = moved(s, dt / 2, s.velocity, a1);
  const auto a2 = accelerations(system, s2);
  const State s3 = moved(s, dt / 2, s2.velocity, a2);
  const auto a3 = accelerations(system, s3);
  const State s4 = moved(s, dt, s3.velocity, a3);
  const auto a4 = accelerations(system, s4);
  State next = moved(s, dt / 6, s.velocity, a1);
  next = moved(next, dt / 3, s2.velocity, a2);
  next = moved(next, dt / 3, s3.velocity, a3);
  return moved(next, dt / 6, s4.velocity, a4);
}
/// Both frozen methods: x + dt v + dt^2/2 a, v + dt a.
State frozen(const System& system, const State& s, double dt) {
  const auto a = accelerations(system, s);
  return moved(s, dt, moved(s, dt / 2, a, a).velocity, a);
}
State explicit_euler(const System& system, const State& s, double dt) {
  return moved(s, dt, s.velocity, accelerations(system, s));
}
const std::array<std::pair<const char*, Method>, 6> methods{{{"semi-euler", semi_euler},
                                                             {"midpoint", midpoint},
                                                             {"rk4", rk4},
                                                             {"midpoint-frozen", frozen},
                                                             {"rk4-frozen", frozen},
                                                             {"explicit-euler", explicit_euler}}};

std::vector<OpenclVariant> variants() {
  std::vector<OpenclVariant> all{{true, most_opencl_lanes, 1}, {true, most_opencl_lanes, 3}};
  for (const int lanes : opencl_lanes) all.push_back({false, lanes});
  return all;
}

TEST(OpenclBackends, AgreeWithTheTextbookMethodsInDoubleOnEveryGrid) {
  constexpr int steps = 41;  // odd: the state ends up in the other pair
  ASSERT_EQ(methods.size(), integrators.size());
  for (const auto& [rows, columns] : {std::pair{1U, 2U},
                                      {2U, 1U},
                                      {1U, 40U},
                                      {40U, 1U},
                                      {3U, 3U},
                                      {9U, 11U},
                                      {17U, 5U},
                                      {37U, 23U},
                                      {50U, 50U}}) {
    const System system = rippled_cloth(rows, columns);
    for (const auto& [name, method] : methods) {
      const Integrator& integrator = *find_integrator(name);
      const double dt = 2 * backend_dt_of(integrator);
      State expected = system.start;
      for (int i = 0; i < steps; ++i) expected = method(system, expected, dt);
      const double moved_by = largest_distance(expected.position, system.start.position);
      for (const OpenclVariant& variant : variants()) {
        const auto backend = variant.make(system, integrator, dt);
        backend->step(steps - 1);
        backend->step(1);
        const State found = backend->state();
        // Each step rounds a position of up to 1 m to float (6e-8) a few times.
        EXPECT_LT(largest_distance(found.position, expected.position), 5e-6)
            << variant.name() << ", " << name << ", " << rows << " x " << columns;
        EXPECT_LT(largest_distance(found.velocity, expected.velocity), 5e-4)
            << variant.name() << ", " << name << ", " << rows << " x " << columns;
        EXPECT_GT(moved_by, 5 * dt);
      }
    }
  }
}

TEST(OpenclBackends, LeaveEveryPinnedNodeExactlyWhereItStarted) {
  const System system = rippled_cloth(9, 11);
  for (const Integrator& integrator : integrators)
    for (const OpenclVariant& variant : variants()) {
      const auto backend = variant.make(system, integrator, 2 * backend_dt_of(integrator));
      backend->step(50);
      const State found = backend->state();
      for (const std::uint32_t pin : system.pins) {
        EXPECT_EQ(found.position[pin], system.start.position[pin])
            << variant.name() << ", " << integrator.name << ", node " << pin;
        EXPECT_EQ(found.velocity[pin], Vec3d{})
            << variant.name() << ", " << integrator.name << ", node " << pin;
      }
    }
}

TEST(OpenclBackends, LetAFreeSheetFallByTheIntegratorsOwnRecurrence) {
  constexpr int steps = 100;
  const System system = flat_cloth(5, 19, 1.0);
  for (const Integrator& integrator : integrators)
    for (const OpenclVariant& variant : variants()) {
      const double dt = 10 * backend_dt_of(integrator);
      const auto backend = variant.make(system, integrator, dt);
      backend->step(steps);
      const State found = backend->state();
      const double travel = fall_of(integrator, steps);
      for (std::size_t node = 0; node < system.nodes(); ++node) {
        EXPECT_NEAR(found.position[node].y, 1.0 - travel * system.gravity * dt * dt, 2e-6)
            << variant.name() << ", " << integrator.name << ", node " << node;
        EXPECT_NEAR(found.position[node].x, system.start.position[node].x, 2e-6);
        EXPECT_NEAR(found.position[node].z, system.start.position[node].z, 2e-6);
        EXPECT_NEAR(found.velocity[node].y, -steps * system.gravity * dt, 1e-5);
      }
    }
}

TEST(OpenclBackends, PutFreeNodesBackOntoTheFloorAndLeavePinnedOnesBelowIt) {
  System system = flat_cloth(3, 18, -0.5);  // below the floor, so that contact comes with the first step
  system.materials = {{0, 0}, {0, 0}, {0, 0}};
  system.gravity = 0;
  system.floor = {.height = 0.25, .restitution = 0.5, .friction = 0.2};
  for (Vec3d& v : system.start.velocity) v = {3, -2, 4};
  system.start.velocity[7] = {1, 2, 0};       // rising already
  system.start.velocity[8] = {0.3, -2, 0.4};  // slides slower than friction can stop
  system.start.velocity[9] = {0, -2, 0};      // does not slide
  system.start.position[10].y = 0.5;          // stays above the floor
  system.pins = {20};
  system.start.velocity[20] = {};
  for (const Integrator& integrator : integrators)
    for (const OpenclVariant& variant : variants()) {
      const auto backend = variant.make(system, integrator, 1e-3);
      backend->step(1);
      const State found = backend->state();
      const auto expect_velocity = [&](std::size_t node, const Vec3d& expected) {
        EXPECT_LT(largest_distance({found.velocity[node]}, {expected}), 1e-6)
            << variant.name() << ", " << integrator.name << ", node " << node;
      };
      EXPECT_EQ(found.position[0].y, 0.25) << variant.name() << ", " << integrator.name;
      // The normal speed changes by 3 m/s, so that friction takes 0.6 m/s of the 5 m/s.
      expect_velocity(0, {3 * 0.88, 1, 4 * 0.88});
      expect_velocity(53, {3 * 0.88, 1, 4 * 0.88});
      EXPECT_EQ(found.position[7].y, 0.25);
      expect_velocity(7, {1, 2, 0});
      expect_velocity(8, {0, 1, 0});
      expect_velocity(9, {0, 1, 0});
      EXPECT_NEAR(found.position[10].y, 0.498, 1e-6);
      expect_velocity(10, {3, -2, 4});
      EXPECT_EQ(found.position[20].y, -0.5);
      expect_velocity(20, {});
    }
}

TEST(OpenclBackends, StartAgainFromTheStateTheyAreGiven) {
  const System system = rippled_cloth(9, 11);
  for (const OpenclVariant& variant : variants()) {
    const auto backend = variant.make(system, integrators.front(), 2e-4);
    backend->step(7);
    const State first = backend->state();
    backend->step(4);
    backend->set_state(system.start);
    backend->step(7);
    EXPECT_EQ(backend->state().position, first.position) << variant.name();
    EXPECT_EQ(backend->state().velocity, first.velocity) << variant.name();
  }
}

TEST(OpenclBackends, GiveTheSameBitsWithAnyNumberOfLanesOrThreads) {
  const System system = rippled_cloth(21, 35);
  for (const Integrator& integrator : integrators) {
    const auto run = [&](const OpenclVariant& variant) {
      const auto backend = variant.make(system, integrator, 2e-4);
      backend->step(30);
      return backend->state().position;
    };
    for (const int lanes : opencl_lanes) {
      if (lanes == 1) continue;  // a GPU's kernel sums the springs in another order
      EXPECT_EQ(run({false, lanes}), run({false, most_opencl_lanes})) << integrator.name << ", " << lanes;
    }
    for (const int threads : {2, 3})
      EXPECT_EQ(run({true, most_opencl_lanes, threads}), run({true, most_opencl_lanes, 1}))
          << integrator.name;
  }
}

TEST(OpenclBackends, GiveTheSameBitsForAnyNumberOfComputeUnitsThatShareACloth) {
  const System system = rippled_cloth(35, 61);
  for (const Integrator& integrator : integrators) {
    std::vector<std::vector<Vec3d>> found;
    for (const std::uint32_t units : {1U, 2U, 7U, 61U}) {  // to one column a work-item
      OpenclDevice device = choose_opencl_device(opencl_offer().devices, "");
      device.compute_units = units;
      const auto backend = make_opencl(system, integrator, 2e-4, device, most_opencl_lanes);
      backend->step(31);
      found.push_back(backend->state().position);
      EXPECT_EQ(found.back(), found.front()) << integrator.name << ", " << units;
    }
  }
}

TEST(OpenclBackends, GiveTheSameBitsHoweverMemoryIsSharedOrCopied) {
  const System system = rippled_cloth(21, 35);
  for (const Integrator& integrator : integrators)
    for (const OpenclVariant variant : {OpenclVariant{false, most_opencl_lanes}, {true, most_opencl_lanes}}) {
      std::vector<State> found;
      for (const DeviceInMemory& memory : ways_to_memory()) {
        const auto backend = variant.make_in(memory, system, integrator, 2e-4);
        backend->step(7);
        backend->set_state(system.start);
        EXPECT_EQ(backend->state().position, system.start.position) << memory.name << ", " << integrator.name;
        backend->step(30);
        found.push_back(backend->state());
        EXPECT_EQ(found.back().position, found[0].position) << memory.name << ", " << integrator.name;
        EXPECT_EQ(found.back().velocity, found[0].velocity) << memory.name << ", " << integrator.name;
      }
      EXPECT_NE(found[0].position, system.start.position);
    }
}

TEST(OpenclBackends, SayWhetherTheirMemoryIsCopied) {
  const std::string name = choose_opencl_device(opencl_offer().devices, "").name;
  for (const std::string_view backend : {"opencl", "hybrid"}) {
    const auto device = [&](DeviceMemory memory) {
      return find_backend(backend)
          ->make(rippled_cloth(3, 4), integrators.front(), 2e-4, {.threads = 2, .memory = memory})
          ->device();
    };
    EXPECT_EQ(device(DeviceMemory::shared), name) << backend;
    EXPECT_EQ(device(DeviceMemory::copy), name + " (copied memory)") << backend;
  }
}

TEST(OpenclBackends, SayHowMuchMemoryAClothNeedsThatTheDeviceDoesNotHave) {
  const System system = rippled_cloth(9, 11);
  OpenclDevice device = choose_opencl_device(opencl_offer().devices, "");
  device.max_allocation_bytes = 1000;
  try {
    make_opencl(system, integrators.front(), 2e-4, device, 1);
    FAIL() << "nothing was thrown";
  } catch (const Unsupported& error) {
    EXPECT_THAT(error.what(), HasSubstr("needs an OpenCL buffer of"));
    EXPECT_THAT(error.what(), HasSubstr(device.name));
  }
}

}  // namespace
}  // namespace mssim
