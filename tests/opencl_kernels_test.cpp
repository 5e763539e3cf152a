// Every kernel that there is, on the smallest systems that use all of it: short enough for a simulator that
// looks for races and uninitialised memory (tests/oclgrind_test.sh).
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "backends/serial.h"
#include "cloth_system.h"
#include "integrators/integrators.h"
#include "largest_distance.h"
#include "opencl_ways.h"
#include "solid_system.h"

namespace mssim {
namespace {

constexpr double dt_s = 1e-4;
constexpr int steps = 3;  // odd: the state ends up in the other pair

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
  const OpenclWay way{hybrid, lanes};
  // In arrays of the host's own: the simulator's are not aligned to vectors.
  const DeviceInMemory copied = ways_to_memory().front();
  // Bands of two rows and a last one that is not full.
  const auto rows = static_cast<std::uint32_t>(lanes + lanes / 2 + 3);
  for (const System& system :
       {held_above_a_floor(cloth_system(rows, 6)), held_above_a_floor(solid_block(3, 2, 4))})
    for (const Integrator& integrator : integrators) {
      const auto reference = make_reference(system, integrator, dt_s);
      reference->step(steps);
      const auto backend = way.make_in(copied, system, integrator, dt_s);
      backend->step(steps);
      // Each step rounds a position of up to 1 m to float (6e-8) a few times.
      EXPECT_LT(largest_distance(backend->state().position, reference->state().position), 1e-6)
          << integrator.name << ", " << system.nodes() << " nodes";
    }
}

}  // namespace
}  // namespace mssim
