// Launches that take several steps through all stages, against launches of one step and of one stage; and
// how many steps a launch is made to take.

#include <variant>

#include "backends/backends.h"
#include "backends/devices/drivers.h"
#include "backends/opencl/cloth.h"
#include "backends/opencl/opencl.h"
#include "garment/contact/body_maps.h"
#include "garment/stepping/dressing_backend.h"
#include "integrators/all_integrators.h"
#include "mesh/meshing.h"
#include "model/system.h"
#include "tests/support/backend_checks.h"
#include "tests/support/garment_system.h"
#include "tests/support/opencl_variants.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// A moving cloth, pinned at some nodes all over it, the last one too, that meets the floor along a wave.
System pinned_cloth_on_a_floor(std::uint32_t rows, std::uint32_t columns) {
  System system = cloth_system(rows, columns);
  system.floor = {.height = 0.5, .restitution = 0.3, .friction = 0.4};
  for (std::uint32_t node = 0; node < system.nodes(); ++node) {
    system.start.position[node].y = 0.5 + 2e-3 * std::sin(0.3 * node);
    system.start.velocity[node] = {0.1 * std::cos(node), 0.2 * std::sin(0.3 * node), 0.1};
  }
  round_to_single(system.start);
  return pinned_all_over(system);
}

/// On a device with that many compute units.
std::unique_ptr<Backend> bands_of(const System& system, const Integrator& integrator, std::uint32_t units,
                                  std::size_t steps_in_a_launch, DeviceMemory memory = DeviceMemory::shared) {
  OpenclDevice device = first_opencl_device();
  device.compute_units = units;
  return make_opencl_grid(system, std::get<GridPatch>(system.topology), integrator, backend_dt_s, device,
                          memory, most_opencl_lanes, steps_in_a_launch);
}

TEST(OpenclBands, GiveTheSameBitsForAnyNumberOfStepsALaunchAndOfWorkItems) {
  constexpr int steps = 31;  // no multiple of those of a launch
  for (const auto& [rows, columns] : {std::pair{1U, 40U}, {5U, 2U}, {35U, 61U}, {3U, 90U}}) {
    const System system = pinned_cloth_on_a_floor(rows, columns);
    for (const char* name : {"semi-euler", "midpoint", "rk4"}) {
      const Integrator& integrator = *find_integrator(name);
      const auto alone = bands_of(system, integrator, 1, 1);
      for (int step = 0; step < steps; ++step) alone->step(1);
      const State expected = alone->state();
      EXPECT_NE(expected.position, system.start.position);
      for (const std::uint32_t units : {1U, 3U, 200U})
        for (const std::size_t count : {1U, 2U, 3U}) {
          const auto backend = bands_of(system, integrator, units, count);
          EXPECT_EQ(backend->steps_per_pass(), static_cast<int>(count));
          backend->step(steps - 6);
          EXPECT_TRUE(same_state(state_after(*backend, 6), expected))
              << name << ", " << rows << " x " << columns << ", " << units << ", " << count;
        }
    }
  }
}

TEST(OpenclBands, StartAgainFromTheStateTheyAreGivenAfterAnyNumberOfLaunches) {
  const System system = pinned_cloth_on_a_floor(21, 61);
  for (const DeviceMemory memory : {DeviceMemory::shared, DeviceMemory::copy})
    for (const int before : {0, 1, 3, 4}) {
      const auto fresh = bands_of(system, *find_integrator("midpoint"), 3, 3, memory);
      fresh->step(8);
      const auto backend = bands_of(system, *find_integrator("midpoint"), 3, 3, memory);
      backend->step(before);
      backend->set_state(system.start);
      EXPECT_EQ(backend->state().position, system.start.position);
      EXPECT_TRUE(same_state(state_after(*backend, 8), fresh->state())) << before;
    }
}

constexpr std::size_t group_lanes = 16;
constexpr std::uint64_t cache_bytes = 32U << 20;

BandShape shape_of(const GridPatch& grid, const char* integrator, std::size_t units = 2) {
  return {grid, *find_integrator(integrator), group_lanes, units, cache_bytes};
}

TEST(BandShape, TakesMoreStepsALaunchTheLessAStepDoes) {
  EXPECT_EQ(shape_of({50, 50, 0.01}, "semi-euler").steps, 11U);
  EXPECT_EQ(shape_of({200, 200, 0.01}, "semi-euler").steps, 5U);
  EXPECT_EQ(shape_of({500, 700, 0.01}, "semi-euler").steps, 2U);
  EXPECT_GE(shape_of({50, 50, 0.01}, "semi-euler").steps, shape_of({50, 50, 0.01}, "rk4").steps);
}

TEST(BandShape, PassesOverAStateInMemoryWithFourStagesAtLeast) {
  const GridPatch grid{1000, 1000, 0.01};
  EXPECT_GE(shape_of(grid, "semi-euler").steps, 4U);
  EXPECT_GE(shape_of(grid, "midpoint").steps, 2U);
  EXPECT_GE(shape_of(grid, "rk4").steps, 1U);
  EXPECT_EQ(BandShape(grid, *find_integrator("semi-euler"), group_lanes, 2, std::uint64_t{1} << 30).steps,
            1U);
}

TEST(BandShape, GivesEveryComputeUnitOfAWideClothSomePartitions) {
  for (const std::size_t units : {1U, 2U, 5U}) {
    const BandShape shape = shape_of({500, 700, 0.01}, "rk4", units);
    EXPECT_GE(shape.partitions, units);
    EXPECT_EQ(shape.partitions % units, 0U);
  }
  EXPECT_GT(shape_of({500, 700, 0.01}, "semi-euler").partitions, 2U);
}

TEST(BandShape, GivesEveryPartitionTheColumnsThatRepeatItInItsNeighbours) {
  for (const Integrator& integrator : integrators)
    for (const std::uint32_t columns : {1U, 2U, 3U, 7U, 16U, 61U, 300U})
      for (const std::size_t units : {1U, 2U, 64U})
        for (const std::size_t steps : {1U, 2U, 4U}) {
          const BandShape shape({9, columns, 0.01}, integrator, group_lanes, units, cache_bytes, steps);
          EXPECT_EQ(shape.steps, steps);
          EXPECT_EQ(shape.ghosts, 2 * steps * integrator.stage_count);
          EXPECT_GT(shape.ring(), shape.ghosts - 1);
          ASSERT_GE(shape.partitions, 1U);
          for (std::size_t p = 0; shape.partitions > 1 && p < shape.partitions; ++p)
            EXPECT_GE(shape.first(p + 1) - shape.first(p), shape.ghosts)
                << integrator.name << ", " << columns << " columns, " << units << " units";
        }
}

// Every kernel that there is, on the smallest systems that use all of it: short enough for a simulator that
// looks for races and uninitialised memory (tests/project/oclgrind_test.sh).

constexpr int few_steps = 3;  // odd: the state ends up in the other pair

/// Pinned here and there, and partly below the floor.
System held_above_a_floor(System system) {
  system = pinned(system, {0, static_cast<std::uint32_t>(system.nodes() - 1)});
  const auto [lowest, highest] =
      std::ranges::minmax(system.start.position, {}, [](const Vec3d& x) { return x.y; });
  system.floor.height = (lowest.y + highest.y) / 2;
  return system;
}

class OpenclKernels : public testing::TestWithParam<std::tuple<bool, int>> {};

INSTANTIATE_TEST_SUITE_P(OfEachBackendAndWidth, OpenclKernels,
                         testing::Combine(testing::Bool(), testing::ValuesIn(opencl_lanes)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param) ? "hybrid_" : "opencl_") +
                                  std::to_string(std::get<1>(test.param)) + "_lanes";
                         });

TEST_P(OpenclKernels, TakeAFewStepsLikeTheReference) {
  const auto [hybrid, lanes] = GetParam();
  const OpenclVariant way{hybrid, lanes};
  // In arrays of the host's own: the simulator's are not aligned to vectors.
  const DeviceInMemory copied = ways_to_memory().front();
  // Bands of two rows and a last one that is not full.
  const auto rows = static_cast<std::uint32_t>(lanes + lanes / 2 + 3);
  for (const System& system :
       {held_above_a_floor(cloth_system(rows, 6)), held_above_a_floor(solid_block(3, 2, 4)),
        alike_bodies(held_above_a_floor(solid_block(2, 2, 3)), 9)})
    for (const Integrator& integrator : integrators) {
      const auto reference = make_reference(system, integrator, backend_dt_s);
      const auto backend = way.make_in(copied, system, integrator, backend_dt_s);
      // Each step rounds a position of up to 1 m to float (6e-8) a few times.
      EXPECT_LT(distance_after(few_steps, *reference, *backend), 1e-6)
          << integrator.name << ", " << system.nodes() << " nodes";
    }
}

class BandsOpenclKernels : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(OfEachWidth, BandsOpenclKernels,
                         testing::ValuesIn(opencl_lanes.begin() + 1, opencl_lanes.end()),
                         [](const auto& test) { return "bands_" + std::to_string(test.param) + "_lanes"; });

TEST_P(BandsOpenclKernels, TakeAFewStepsLikeTheReferenceOnSeveralWorkItems) {
  const DeviceInMemory copied = ways_to_memory().front();
  const System system = held_above_a_floor(cloth_system(5, 33));
  const auto& grid = std::get<GridPatch>(system.topology);
  for (const char* name : {"semi-euler", "rk4"}) {
    const Integrator& integrator = *find_integrator(name);
    const auto reference = make_reference(system, integrator, backend_dt_s);
    // Two work-items of rk4, in a launch of two steps and one of one.
    const auto backend =
        make_opencl_grid(system, grid, integrator, backend_dt_s, copied.device, copied.memory, GetParam(), 2);
    EXPECT_LT(distance_after(few_steps, *reference, *backend), 1e-6) << name;
  }
}

class DressingOpenclKernels : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(OfEachWidth, DressingOpenclKernels, testing::ValuesIn(opencl_lanes),
                         [](const auto& test) {
                           return "dressing_" + std::to_string(test.param) + "_lanes";
                         });

TEST_P(DressingOpenclKernels, TakeAFewStepsLikeTheReference) {
  // Two blocks of rows and one; a seam of open joints, and one that is sewn at once.
  System system = garment_of({{33, 5, 0.01, {-0.0212, 0, 0.0187}}, {17, 3, 0.01, {0.0338, 0, 0.0187}}});
  Garment& garment = garment_in(system);
  for (std::uint32_t row = 0; row < 17; ++row)
    garment.joints.push_back({garment.panels[1].node(row, 0), garment.panels[0].node(row, 4),
                              garment.panels[0].node(row + 1, 4), 0.3, 0.01, 1, 0});
  garment.joints.push_back({garment.panels[1].node(16, 2), garment.panels[1].node(15, 2),
                            garment.panels[1].node(15, 2), 0, 0.01, 1, 0});
  garment.seams = {"side"};
  garment.body_maps = {std::make_shared<BodyMaps>(surface_of(SphereShape{0.02, 8}), BodyMapSettings{})};
  system.pins = {garment.panels[0].node(32, 0)};
  system.gravity = 9.81;
  system.floor.height = 0.005;                        // above the lowest row
  for (Vec3d& x : system.start.position) x.y *= 1.1;  // too long, all
  round_to_single(system.start);
  const auto reference = make_reference_dressing(system, semi_euler, backend_dt_s);
  const DeviceInMemory copied = ways_to_memory().front();
  const int lanes = GetParam();
  const auto backend = make_opencl_dressing(system, semi_euler, backend_dt_s, copied.device, copied.memory,
                                            {lanes, lanes == 1 ? std::size_t{8} : 1});
  EXPECT_LT(distance_after(few_steps, *reference, *backend), 1e-6);
}

}  // namespace
}  // namespace mssim
