#include "backends/layouts/band_cut.h"

#include <gtest/gtest.h>

#include "integrators/all_integrators.h"

namespace mssim {
namespace {

/// Of vectors of 16 lanes.
std::size_t halves(std::uint32_t rows, std::uint32_t columns, const char* integrator, std::size_t threads) {
  return halves_for(BandLayout(GridPatch{rows, columns, 0.01}, 16), *find_integrator(integrator), 1, threads);
}

TEST(BandCut, FoldsAClothWhoseBandsAreLow) {
  for (const std::size_t threads : {1U, 2U}) {
    EXPECT_EQ(halves(50, 50, "semi-euler", threads), 2U);
    EXPECT_EQ(halves(100, 100, "semi-euler", threads), 2U);
  }
}

TEST(BandCut, DoesNotFoldWhatWouldBeWalkedOverTwice) {
  EXPECT_EQ(halves(50, 50, "rk4", 2), 1U) << "the halves would recompute twelve columns each";
  EXPECT_EQ(halves(50, 50, "semi-euler", 12), 1U) << "two columns a thread and half";
  EXPECT_EQ(halves(50, 2, "semi-euler", 1), 1U);
}

TEST(BandCut, DoesNotFoldColumnsThatTheCacheDoesNotHold) {
  EXPECT_EQ(halves(10000, 700, "semi-euler", 1), 1U);
}

TEST(BandCut, LeavesNoPartitionNarrowerThanWhatOthersReadOfIt) {
  for (const Integrator& integrator : integrators)
    for (const std::size_t steps : {1U, 2U, 4U})
      for (const std::size_t columns : {1U, 9U, 50U, 700U})
        for (const std::size_t threads : {1U, 2U, 64U}) {
          const std::size_t partitions = partitions_for(columns, threads, integrator, steps);
          ASSERT_GE(partitions, 1U);
          EXPECT_LE(partitions, threads);
          if (partitions > 1) {
            EXPECT_GE(columns / partitions, ghost_columns(integrator, steps));
          }
        }
}

}  // namespace
}  // namespace mssim
