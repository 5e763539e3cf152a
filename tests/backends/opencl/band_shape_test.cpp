#include "backends/opencl/band_shape.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "integrators/all_integrators.h"
#include "model/topology.h"

namespace mssim {
namespace {

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

}  // namespace
}  // namespace mssim
