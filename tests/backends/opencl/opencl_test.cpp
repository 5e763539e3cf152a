#include "backends/opencl/opencl.h"

#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "tests/support/backend_checks.h"
#include "tests/support/opencl_variants.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

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
    for (std::uint32_t column = 0; column < columns; ++column)
      system.start.add({0.02 * column, height, 0.02 * row}, {});
  return system;
}

/// The same, rippled, moving, with air drag, and pinned at some nodes all over it, its last one too.
System rippled_cloth(std::uint32_t rows, std::uint32_t columns) {
  System system = flat_cloth(rows, columns, 0.5);
  system.viscous_damping = 0.3;
  for (std::uint32_t node = 0; node < system.nodes(); ++node) {
    system.start.position[node] +=
        {1e-3 * std::sin(node), 4e-3 * std::cos(0.7 * node), 1e-3 * std::sin(2.0 * node)};
    system.start.velocity[node] = {0.1 * std::cos(node), 0.2 * std::sin(0.3 * node), 0.1};
  }
  round_to_single(system.start);
  return pinned_all_over(system);
}

std::vector<OpenclVariant> variants() {
  std::vector<OpenclVariant> all{{true, most_opencl_lanes, 1}, {true, most_opencl_lanes, 3}};
  for (const int lanes : opencl_lanes) all.push_back({false, lanes});
  return all;
}

TEST(OpenclBackends, AgreeWithTheReferenceOnEveryGridAndHoldPinsExactly) {
  constexpr int steps = 41;  // odd: the state ends up in the other pair
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
    for (const Integrator& integrator : integrators) {
      const double dt = 2 * backend_dt_of(integrator);
      const State expected = state_after(*make_reference(system, integrator, dt), steps);
      EXPECT_GT(largest_distance(expected.position, system.start.position), 5 * dt);
      for (const OpenclVariant& variant : variants()) {
        const auto backend = variant.make(system, integrator, dt);
        backend->step(steps - 1);
        const State found = state_after(*backend, 1);
        SCOPED_TRACE(variant.name() + ", " + std::string(integrator.name) + ", " +
                     std::to_string(system.nodes()));
        // Each step rounds a position of up to 1 m to float (6e-8) a few times.
        EXPECT_LT(largest_distance(found.position, expected.position), 5e-6);
        EXPECT_LT(largest_distance(found.velocity, expected.velocity), 5e-4);
        EXPECT_TRUE(pins_hold(system, found));
      }
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
  round_to_single(system.start);
  for (const Integrator& integrator : integrators) {
    const State expected = state_after(*make_reference(system, integrator, 1e-3), 1);
    EXPECT_EQ(expected.position[0].y, 0.25);
    for (const OpenclVariant& variant : variants()) {
      const auto backend = variant.make(system, integrator, 1e-3);
      backend->step(1);
      SCOPED_TRACE(variant.name() + ", " + std::string(integrator.name));
      EXPECT_LT(largest_distance(backend->state().velocity, expected.velocity), 1e-6);
      EXPECT_LT(largest_distance(backend->state().position, expected.position), 1e-6);
      EXPECT_EQ(backend->state().position[0].y, 0.25);
      EXPECT_TRUE(pins_hold(system, backend->state()));
    }
  }
}

TEST(OpenclBackends, StartAgainFromTheStateTheyAreGiven) {
  const System system = rippled_cloth(9, 11);
  for (const OpenclVariant& variant : variants()) {
    SCOPED_TRACE(variant.name());
    expect_starts_again(*variant.make(system, integrators.front(), 2e-4), system);
  }
}

TEST(OpenclBackends, GiveTheSameBitsWithAnyNumberOfLanesOrThreads) {
  for (const System& system :
       {rippled_cloth(21, 35), solid_block(7, 5, 6), alike_bodies(solid_block(3, 4, 3), 19)})
    for (const Integrator& integrator : integrators) {
      SCOPED_TRACE(std::string(integrator.name) + ", " + std::to_string(system.nodes()));
      const auto run = [&](const OpenclVariant& variant) {
        const auto backend = variant.make(system, integrator, backend_dt_of(integrator));
        backend->step(30);
        return backend->state().position;
      };
      for (const int lanes : opencl_lanes) {
        if (lanes == 1) continue;  // a GPU's kernels sum the springs in another order
        for (const bool hybrid : {false, true})
          EXPECT_EQ(run({hybrid, lanes}), run({hybrid, most_opencl_lanes})) << lanes;
      }
      for (const int threads : {2, 3})
        EXPECT_EQ(run({true, most_opencl_lanes, threads}), run({true, most_opencl_lanes, 1}));
    }
}

TEST(OpenclBackends, GiveTheSameBitsForAnyNumberOfComputeUnitsThatShareACloth) {
  const System system = rippled_cloth(35, 61);
  for (const Integrator& integrator : integrators) {
    std::vector<std::vector<Vec3d>> found;
    for (const std::uint32_t units : {1U, 2U, 7U, 61U}) {  // to one column a work-item
      OpenclDevice device = first_opencl_device();
      device.compute_units = units;
      const auto backend = make_opencl(system, integrator, 2e-4, device, most_opencl_lanes);
      backend->step(31);
      found.push_back(backend->state().position);
      EXPECT_EQ(found.back(), found.front()) << integrator.name << ", " << units;
    }
  }
}

TEST(OpenclBackends, GiveTheSameBitsHoweverMemoryIsSharedOrCopied) {
  for (const System& system :
       {rippled_cloth(21, 35), two_solid_blocks(), alike_bodies(solid_block(3, 4, 3), 11)})
    for (const Integrator& integrator : integrators)
      for (const OpenclVariant variant :
           {OpenclVariant{false, most_opencl_lanes}, {true, most_opencl_lanes}}) {
        SCOPED_TRACE(fmt::format("{}, {}, {} nodes", variant.name(), integrator.name, system.nodes()));
        std::vector<State> found;
        for (const DeviceInMemory& memory : ways_to_memory()) {
          SCOPED_TRACE(memory.name);
          const auto backend = variant.make_in(memory, system, integrator, backend_dt_s);
          backend->step(7);
          backend->set_state(system.start);
          EXPECT_EQ(backend->state().position, system.start.position);
          backend->step(31);
          found.push_back(backend->state());
          EXPECT_TRUE(same_state(found.back(), found[0]));
        }
        EXPECT_NE(found[0].position, system.start.position);
      }
}

TEST(OpenclBackends, SayWhetherTheirMemoryIsCopied) {
  const std::string name = first_opencl_device().name;
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
  OpenclDevice device = first_opencl_device();
  device.max_allocation_bytes = 1000;
  EXPECT_THAT(sentence_of<Unsupported>([&] { make_opencl(system, integrators.front(), 2e-4, device, 1); }),
              AllOf(HasSubstr("needs an OpenCL buffer of"), HasSubstr(device.name)));
}

}  // namespace
}  // namespace mssim
