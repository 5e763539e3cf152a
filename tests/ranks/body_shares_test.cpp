#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "ranks/shares.h"

namespace mssim {
namespace {

using ::testing::ElementsAre;
using Shares = std::vector<std::vector<BodyShare>>;

/// [ranks] nodes that each has. Fails where a body is not given out exactly, or a part is too small.
std::vector<std::size_t> loads_of(const Shares& shares, const std::vector<std::size_t>& nodes, int ranks) {
  std::vector<std::size_t> loads(static_cast<std::size_t>(ranks), 0);
  EXPECT_EQ(shares.size(), nodes.size());
  for (std::size_t body = 0; body < shares.size(); ++body) {
    std::size_t given = 0;
    for (const BodyShare& share : shares[body]) {
      given += share.nodes;
      loads.at(static_cast<std::size_t>(share.rank)) += share.nodes;
      EXPECT_GE(share.nodes, std::min(nodes[body], least_share));
      EXPECT_EQ(std::ranges::count(shares[body], share.rank, &BodyShare::rank), 1) << "a rank has two parts";
    }
    EXPECT_EQ(given, nodes[body]);
  }
  return loads;
}

std::size_t divided(const Shares& shares) {
  return static_cast<std::size_t>(
      std::ranges::count_if(shares, [](const auto& body) { return body.size() > 1; }));
}

TEST(BodyShares, LeavesBodiesWholeWhereThatBalances) {
  EXPECT_THAT(*body_shares({1000, 1000}, 1),
              ElementsAre(ElementsAre(BodyShare{0, 1000}), ElementsAre(BodyShare{0, 1000})));
  EXPECT_THAT(*body_shares({1000, 1050, 990}, 3),
              ElementsAre(ElementsAre(BodyShare{1, 1000}), ElementsAre(BodyShare{0, 1050}),
                          ElementsAre(BodyShare{2, 990})));
  EXPECT_EQ(divided(*body_shares(std::vector<std::size_t>(13, 2941), 2)), 0U);  // 7.7 % above the mean
  EXPECT_EQ(divided(*body_shares({4, 4, 4}, 3)), 0U);
}

TEST(BodyShares, DividesTheLargestBodiesAndNoMoreThanItTakes) {
  EXPECT_THAT(*body_shares({900}, 3),
              ElementsAre(ElementsAre(BodyShare{0, 300}, BodyShare{1, 300}, BodyShare{2, 300})));
  EXPECT_THAT(*body_shares({100, 300}, 2),
              ElementsAre(ElementsAre(BodyShare{0, 100}), ElementsAre(BodyShare{1, 200}, BodyShare{0, 100})));
  EXPECT_EQ(divided(*body_shares({500, 500, 500, 500}, 3)), 1U);
  EXPECT_EQ(divided(*body_shares({500, 500, 500, 500, 500}, 3)), 2U);
  const Shares one_large = *body_shares({3000, 500, 400, 100}, 4);
  EXPECT_EQ(divided(one_large), 1U);
  EXPECT_EQ(one_large[0].size(), 4U);
}

TEST(BodyShares, GivesEveryRankAboutTheSameWhereBodiesAreLarge) {
  for (const std::vector<std::size_t>& nodes : {std::vector<std::size_t>{100000},
                                                {100000, 90000, 100},
                                                {5000, 100000, 7000, 800},
                                                {620, 700, 726, 962, 1579, 1599, 1977, 2941, 3002},
                                                std::vector<std::size_t>(30, 2941)})
    for (int ranks = 1; ranks <= 24; ++ranks) {
      SCOPED_TRACE(std::to_string(nodes.size()) + " bodies on " + std::to_string(ranks));
      const auto shares = body_shares(nodes, ranks);
      ASSERT_TRUE(shares);
      const std::vector<std::size_t> loads = loads_of(*shares, nodes, ranks);
      const double mean =
          static_cast<double>(std::reduce(nodes.begin(), nodes.end())) / static_cast<double>(ranks);
      EXPECT_LE(static_cast<double>(std::ranges::max(loads)), 1.1 * mean);
      EXPECT_GT(std::ranges::min(loads), 0U);
    }
}

TEST(BodyShares, CutsAsLongAsPartsHaveNodesEnough) {
  for (std::size_t nodes = least_share; nodes < 20 * least_share; ++nodes) {
    const auto most = static_cast<int>(nodes / least_share);
    const auto shares = body_shares({nodes}, most);
    ASSERT_TRUE(shares) << nodes;
    EXPECT_GT(std::ranges::min(loads_of(*shares, {nodes}, most)), 0U) << nodes;
    EXPECT_FALSE(body_shares({nodes}, most + 1)) << nodes;
    EXPECT_EQ(most_ranks({nodes}, 100), most);
  }
  EXPECT_FALSE(body_shares({20, 20, 4}, 4));
  EXPECT_EQ(most_ranks({20, 20, 4}, 1000), 3);
  EXPECT_EQ(most_ranks({76, 76, 76}, 1000), 12);
}

TEST(BodyShares, GivesManySmallBodiesBesideALargeOne) {
  std::vector<std::size_t> nodes(40, 10);
  nodes.push_back(1000);
  for (int ranks = 1; ranks <= 40; ++ranks) {
    const auto shares = body_shares(nodes, ranks);
    ASSERT_TRUE(shares) << ranks;
    EXPECT_GT(std::ranges::min(loads_of(*shares, nodes, ranks)), 0U) << ranks;
    EXPECT_LE(divided(*shares), 1U) << ranks;
  }
}

}  // namespace
}  // namespace mssim
