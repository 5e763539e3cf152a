#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ranks/shares.h"

namespace mssim {
namespace {

using ::testing::ElementsAre;

TEST(RanksByWeight, GivesTheHeaviestFirstToTheRankWithTheLeast) {
  EXPECT_THAT(ranks_by_weight({5, 3, 9, 1}, 2), ElementsAre(1, 1, 0, 1));
  EXPECT_THAT(ranks_by_weight({4, 4, 4}, 3), ElementsAre(0, 1, 2));
  EXPECT_THAT(ranks_by_weight({7, 8}, 1), ElementsAre(0, 0));
}

TEST(RanksByWeight, LeavesNoRankWithoutOneWhereThereAreEnough) {
  for (int ranks = 1; ranks <= 6; ++ranks) {
    const std::vector<int> rank_of = ranks_by_weight({100, 1, 1, 1, 1, 1}, ranks);
    for (int rank = 0; rank < ranks; ++rank) EXPECT_THAT(rank_of, testing::Contains(rank));
  }
}

}  // namespace
}  // namespace mssim
