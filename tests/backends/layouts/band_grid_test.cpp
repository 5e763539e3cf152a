#include "backends/layouts/band_grid.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "integrators/all_integrators.h"
#include "model/topology.h"

namespace mssim {
namespace {

constexpr float gravity = 9.81F;

std::vector<SpringConstants> constants() {
  std::vector<SpringConstants> all;
  for (const double stiffness : {200, 60, 8}) all.emplace_back(SpringMaterial{stiffness, 0.01}, 0.1, 0.002);
  return all;
}

/// Expects the constants of every spring that is there, and zeros for the others.
void expect_springs_of_cloth(const BandLayout& layout, ColumnsToEnd to_end) {
  const std::vector<SpringConstants> springs = constants();
  const BandRows band_rows(layout, springs, gravity, to_end);
  const std::size_t lanes = layout.lanes;
  const auto halo = static_cast<std::ptrdiff_t>(BandLayout::halo);
  const auto height = static_cast<std::ptrdiff_t>(layout.height);
  const auto is_there = [&](std::ptrdiff_t row, std::size_t columns_behind, std::size_t half) {
    return row >= 0 && row < static_cast<std::ptrdiff_t>(layout.rows) && columns_behind < to_end[half];
  };
  for (std::ptrdiff_t row = -halo; row < height + halo; ++row) {
    const float* of_row = band_rows.values() + band_rows.offset_of_row()[row];
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t half = lane / layout.bands;
      const std::ptrdiff_t of_cloth = static_cast<std::ptrdiff_t>(lane % layout.bands) * height + row;
      EXPECT_EQ(of_row[BandRows::gravity_vector * lanes + lane], is_there(of_cloth, 0, half) ? gravity : 0);
      for (std::size_t i = 0; i < grid_stencil.size(); ++i) {
        const auto columns = static_cast<std::size_t>(grid_stencil[i].columns);
        const bool exists =
            is_there(of_cloth, 0, half) && is_there(of_cloth + grid_stencil[i].rows, columns, half);
        const SpringConstants& spring = springs[grid_stencil[i].kind];
        const float* found = of_row + i * BandRows::spring_vectors * lanes + lane;
        EXPECT_EQ(found[0], exists ? spring.stiffness : 0) << "row " << row << ", spring " << i;
        EXPECT_EQ(found[lanes], exists ? spring.stiffness_rest : 0) << "row " << row << ", spring " << i;
        EXPECT_EQ(found[2 * lanes], exists ? spring.damping : 0) << "row " << row << ", spring " << i;
      }
    }
  }
}

TEST(BandRows, HaveConstantsWhereThereIsASpring) {
  for (const std::uint32_t rows : {1U, 2U, 9U, 50U, 100U, 500U})
    for (const std::size_t lanes : {1U, 4U, 8U, 16U}) {
      SCOPED_TRACE(std::to_string(rows) + " rows, " + std::to_string(lanes) + " lanes");
      expect_springs_of_cloth(BandLayout(GridPatch{rows, 3, 0.1}, lanes),
                              {BandRows::far_from_end, BandRows::far_from_end});
    }
}

TEST(BandRows, OfAFoldedClothHaveNoneWhereOneHalfEnds) {
  for (const std::uint32_t rows : {1U, 9U, 100U})
    for (const std::size_t lanes : {2U, 4U, 16U})
      for (std::size_t to_end = 0; to_end <= BandRows::far_from_end; ++to_end) {
        SCOPED_TRACE(std::to_string(rows) + " rows, " + std::to_string(lanes) +
                     " lanes, columns to the end: " + std::to_string(to_end));
        const BandLayout folded(GridPatch{rows, 9, 0.1}, lanes, 2);
        expect_springs_of_cloth(folded, {BandRows::far_from_end, to_end});
        expect_springs_of_cloth(folded, {to_end, BandRows::far_from_end});
      }
}

TEST(BandRows, ShareTheirValues) {
  const BandLayout layout(GridPatch{2000, 3, 0.1}, 16);
  const BandRows band_rows(layout, constants(), gravity);
  const std::uint32_t* offsets = band_rows.offset_of_row();
  const std::set<std::uint32_t> different(offsets, offsets + layout.height);
  EXPECT_LE(different.size(), 4U) << "a few at the top, where a lane has no springs upwards, and at the end";
}

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
