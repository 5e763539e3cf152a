#include "ranks/requests.h"
#include "ranks/shares.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

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

TEST(BodyShares, GivesIdleRanksAPartThoughTheMeanIsLess) {
  EXPECT_THAT(*body_shares({4, 4, 44}, 4),
              ElementsAre(ElementsAre(BodyShare{0, 4}), ElementsAre(BodyShare{1, 4}),
                          ElementsAre(BodyShare{2, 16}, BodyShare{3, 28})));
  EXPECT_EQ(most_ranks({4, 4, 44}, 1000), 4);
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

TEST(RanksByWeight, GivesTheHeaviestFirstToTheRankWithTheLeast) {
  EXPECT_THAT(ranks_by_weight({5, 3, 9, 1}, 2), ElementsAre(1, 1, 0, 1));
  EXPECT_THAT(ranks_by_weight({4, 4, 4}, 3), ElementsAre(0, 1, 2));
  EXPECT_THAT(ranks_by_weight({7, 8}, 1), ElementsAre(0, 0));
}

TEST(RanksByWeight, LeavesNoRankWithoutOneWhereThereAreEnough) {
  for (int ranks = 1; ranks <= 6; ++ranks) {
    const std::vector<int> rank_of = ranks_by_weight({100, 1, 1, 1, 1, 1}, ranks);
    for (int rank = 0; rank < ranks; ++rank) EXPECT_THAT(rank_of, Contains(rank));
  }
}

/// What is made of a text that comes in pieces of seven bytes.
struct Heard {
  std::string reason, passed_on;
  bool started, failed;
};

Heard heard(const std::string& text) {
  constexpr std::size_t piece = 7;
  std::ostringstream passed_on;
  LauncherOutput output(passed_on);
  for (std::size_t i = 0; i < text.size(); i += piece) output.take(std::string_view(text).substr(i, piece));
  return {output.reason(), passed_on.str(), output.ranks_started(), output.rank_has_failed()};
}

TEST(LauncherOutput, SaysThatTheRanksHaveStartedAndPassesOnTheRest) {
  const Heard output =
      heard("first\nmssim-mpi: all ranks have started\nmpirun: Forwarding signal 18 to job\nsecond\n");
  EXPECT_TRUE(output.started);
  EXPECT_EQ(output.passed_on, "first\nsecond\n");
  EXPECT_FALSE(output.failed);
  EXPECT_FALSE(heard("first\n").started);
  EXPECT_TRUE(heard("mssim-mpi: rank 1 on a: it is broken\n").failed);
}

TEST(LauncherOutput, GivesTheReasonOfAFailure) {
  const std::string asterisks = std::string(74, '*') + '\n', dashes = std::string(74, '-') + '\n';
  const std::string no_route = "ssh: connect to host b port 22: No route to host";
  const std::string slots = dashes +
                            "There are not enough slots available in the system to satisfy the 3\nslots that "
                            "were requested by the application:\n\n  mssim-mpi\n\nEither request fewer.\n" +
                            dashes;
  const std::string no_slots =
      "There are not enough slots available in the system to satisfy the 3 slots that were requested by the "
      "application:";
  for (const auto& [text, reason] : std::vector<std::pair<std::string, std::string>>{
           {"", "it printed nothing"},
           {"one\ntwo\n\n", "two"},  // the last line, where nothing else is known
           // Frames are no reason.
           {"sh: mpirunx: not found\n" + asterisks, "sh: mpirunx: not found"},
           {asterisks + "no slots are left\n" + asterisks, "no slots are left"},
           // What a rank says comes first, then what the launcher says of one.
           {"mssim-mpi: rank 1 on a: it is broken\n" + dashes +
                "MPI_ABORT was invoked on rank 1 in communicator MPI_COMM_WORLD\n" + dashes +
                "mssim-mpi: rank 0 on a: it is broken too\n",
            "rank 1 on a: it is broken"},
           {dashes + "Primary job  terminated normally, but 1 process returned\na non-zero exit code.\n" +
                dashes + dashes +
                "mpirun noticed that process rank 1 with PID 0 on node b exited on signal 9 (Killed).\n" +
                dashes,
            "mpirun noticed that process rank 1 with PID 0 on node b exited on signal 9 (Killed)."},
           {"srun: error: b: task 1: Killed\nsrun: launch/slurm: done\n", "srun: error: b: task 1: Killed"},
           // The first paragraph between dashes, behind what ssh says; notes of Open MPI are no reason.
           {slots, no_slots},
           {no_route + '\n' + slots, no_route + "; " + no_slots},
           {no_route +
                "\n[a:983] plm:rsh: Warning: setpgid(997,997) failed in parent with errno=Permission "
                "denied(13)\n\n" +
                dashes + "ORTE was unable to reliably start one or more daemons.\n" + dashes,
            no_route + "; ORTE was unable to reliably start one or more daemons."}})
    EXPECT_EQ(heard(text).reason, reason);
}

}  // namespace
}  // namespace mssim
