#include "backends/packed_springs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <map>
#include <tuple>
#include <vector>

#include "cloth_system.h"
#include "solid_system.h"

namespace mssim {
namespace {

constexpr std::size_t side_by_side = PackedSprings::side_by_side;

/// A unit as the kernel reads it, in the scene's numbers, the lower node first.
std::tuple<std::uint32_t, std::uint32_t, float, std::uint32_t> unit_at(const PackedSprings& packed,
                                                                       std::size_t unit) {
  const std::uint32_t* at = &packed.units[unit / side_by_side * 3 * side_by_side + unit % side_by_side];
  const std::uint32_t first = packed.scene_node[at[0]], second = packed.scene_node[at[side_by_side]];
  return {std::min(first, second), std::max(first, second), std::bit_cast<float>(at[2 * side_by_side]),
          packed.kinds[unit / side_by_side]};
}

class EachSystem : public testing::TestWithParam<int> {
 protected:
  const System system = GetParam() == 0   ? solid_block(7, 5, 6)
                        : GetParam() == 1 ? two_solid_blocks()
                        : GetParam() == 2 ? solid_block(2, 2, 2)
                                          : cloth_system(13, 9);
  const PackedSprings packed{system};
};
INSTANTIATE_TEST_SUITE_P(Systems, EachSystem, testing::Range(0, 4));

TEST_P(EachSystem, PacksEverySpringOnceInUnitsOfOneKindSideBySide) {
  std::map<std::tuple<std::uint32_t, std::uint32_t, float, std::uint32_t>, int> springs;
  for (const Spring& spring : system.springs)
    ++springs[{std::min(spring.first, spring.second), std::max(spring.first, spring.second),
               spring.rest_length, spring.kind}];
  for (std::size_t unit = 0; unit < packed.unit_count(); ++unit) {
    const auto found = unit_at(packed, unit);
    if (std::get<0>(found) != std::get<1>(found)) --springs[found];
  }
  for (const auto& [spring, count] : springs) EXPECT_EQ(count, 0) << std::get<0>(spring);
}

TEST_P(EachSystem, AddsEveryForceAtTheFirstAndSubtractsItAtTheSecondEnd) {
  std::vector<std::vector<std::size_t>> added(packed.places()), subtracted(packed.places());
  for (std::size_t slice = 0; slice < packed.slices(); ++slice)
    for (const bool subtracts : {false, true}) {
      const std::size_t bound = 2 * slice + (subtracts ? 1 : 0);
      for (std::size_t entry = packed.first_entry[bound]; entry < packed.first_entry[bound + 1]; ++entry)
        for (std::size_t i = 0; i < PackedSprings::slice_nodes; ++i) {
          const std::size_t unit = packed.entries[entry * PackedSprings::slice_nodes + i];
          if (unit == packed.unit_count()) continue;
          (subtracts ? subtracted : added)[slice * PackedSprings::slice_nodes + i].push_back(unit);
        }
    }
  std::size_t ends = 0;
  for (std::size_t place = 0; place < packed.places(); ++place) {
    for (const std::size_t unit : added[place])
      EXPECT_EQ(packed.units[unit / side_by_side * 3 * side_by_side + unit % side_by_side], place);
    for (const std::size_t unit : subtracted[place])
      EXPECT_EQ(packed.units[(unit / side_by_side * 3 + 1) * side_by_side + unit % side_by_side], place);
    ends += added[place].size() + subtracted[place].size();
  }
  EXPECT_EQ(ends, 2 * system.springs.size());
}

TEST_P(EachSystem, NumbersEveryNodeOnce) {
  ASSERT_EQ(packed.places() % PackedSprings::slice_nodes, 0U);
  ASSERT_LT(packed.places(), system.nodes() + PackedSprings::slice_nodes);
  for (std::size_t place = system.nodes(); place < packed.places(); ++place)
    EXPECT_EQ(packed.scene_node[place], PackedSprings::no_node);
  for (std::uint32_t node = 0; node < system.nodes(); ++node)
    EXPECT_EQ(packed.scene_node[packed.place[node]], node);
}

}  // namespace
}  // namespace mssim
