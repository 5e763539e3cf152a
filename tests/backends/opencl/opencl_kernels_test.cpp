// Every kernel that there is, on the smallest systems that use all of it: short enough for a simulator that
// looks for races and uninitialised memory (tests/project/oclgrind_test.sh).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "backends/backends.h"
#include "backends/opencl/cloth.h"
#include "garment/contact/body_maps.h"
#include "garment/stepping/dressing_backend.h"
#include "integrators/all_integrators.h"
#include "mesh/shapes.h"
#include "tests/support/backend_step.h"
#include "tests/support/cloth_system.h"
#include "tests/support/garment_system.h"
#include "tests/support/largest_distance.h"
#include "tests/support/opencl_variants.h"
#include "tests/support/solid_system.h"

namespace mssim {
namespace {

constexpr int few_steps = 3;  // odd: the state ends up in the other pair

/// Pinned here and there, and partly below the floor.
System held_above_a_floor(System system) {
  system.pins = {0, static_cast<std::uint32_t>(system.nodes() - 1)};
  for (const std::uint32_t pin : system.pins) system.start.velocity[pin] = {};
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
      reference->step(few_steps);
      const auto backend = way.make_in(copied, system, integrator, backend_dt_s);
      backend->step(few_steps);
      // Each step rounds a position of up to 1 m to float (6e-8) a few times.
      EXPECT_LT(largest_distance(backend->state().position, reference->state().position), 1e-6)
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
    reference->step(few_steps);
    // Two work-items of rk4, in a launch of two steps and one of one.
    const auto backend =
        make_opencl_grid(system, grid, integrator, backend_dt_s, copied.device, copied.memory, GetParam(), 2);
    backend->step(few_steps);
    EXPECT_LT(largest_distance(backend->state().position, reference->state().position), 1e-6) << name;
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
  const Integrator& semi_euler = *find_integrator("semi-euler");
  const auto reference = make_reference_dressing(system, semi_euler, backend_dt_s);
  reference->step(few_steps);
  const DeviceInMemory copied = ways_to_memory().front();
  const int lanes = GetParam();
  const auto backend = make_opencl_dressing(system, semi_euler, backend_dt_s, copied.device, copied.memory,
                                            {lanes, lanes == 1 ? std::size_t{8} : 1});
  backend->step(few_steps);
  EXPECT_LT(largest_distance(backend->state().position, reference->state().position), 1e-6);
}

}  // namespace
}  // namespace mssim
