#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "statistics/rank_tests.h"

namespace mssim {
namespace {

/// Share of the values that are at most s.
double share_up_to(const std::vector<std::size_t>& values, std::size_t s) {
  std::size_t count = 0;
  for (const std::size_t value : values) count += value <= s;
  return static_cast<double>(count) / static_cast<double>(values.size());
}

TEST(RankSumDistribution, EqualsTheEnumerationOfAllArrangements) {
  for (std::size_t m = 1; m <= 5; ++m)
    for (std::size_t n = 1; n <= 6; ++n) {
      std::vector<std::size_t> statistics;  // of each set of m of the m + n places, as bits
      for (std::uint32_t set = 0; set < 1U << (m + n); ++set) {
        if (std::popcount(set) != static_cast<int>(m)) continue;
        std::size_t u = 0;
        for (std::size_t place = 0; place < m + n; ++place)
          if (set >> place & 1U)
            u += place - static_cast<std::size_t>(std::popcount(set & ((1U << place) - 1)));
        statistics.push_back(u);
      }
      const RankDistribution distribution = rank_sum_distribution(m, n);
      ASSERT_TRUE(distribution.is_exact());
      for (std::size_t u = 0; u <= m * n; ++u) {
        const auto value = static_cast<double>(u);
        EXPECT_NEAR(distribution.at_most(value), share_up_to(statistics, u), 1e-14)
            << m << ' ' << n << ' ' << u;
        const double below = u == 0 ? 0 : share_up_to(statistics, u - 1);
        EXPECT_NEAR(distribution.at_least(value), 1 - below, 1e-14) << m << ' ' << n << ' ' << u;
      }
    }
}

TEST(SignedRankDistribution, EqualsTheEnumerationOfAllSigns) {
  for (std::size_t n = 1; n <= 11; ++n) {
    std::vector<std::size_t> statistics;
    for (std::uint32_t positive = 0; positive < 1U << n; ++positive) {
      std::size_t v = 0;
      for (std::size_t i = 0; i < n; ++i)
        if (positive >> i & 1U) v += i + 1;
      statistics.push_back(v);
    }
    const RankDistribution distribution = signed_rank_distribution(n);
    ASSERT_TRUE(distribution.is_exact());
    for (std::size_t v = 0; v <= n * (n + 1) / 2; ++v)
      EXPECT_NEAR(distribution.at_most(static_cast<double>(v)), share_up_to(statistics, v), 1e-14)
          << n << ' ' << v;
  }
}

TEST(RankDistributions, PassIntoTheNormalOneWithoutAJump) {
  // The tail of the largest exact one and of its normal approximation, two deviations out.
  const auto size = static_cast<double>(exact_below - 1);
  const double mean = size * size / 2, deviation = std::sqrt(size * size * (2 * size + 1) / 12);
  const double u = std::floor(mean - 2 * deviation);
  EXPECT_NEAR(rank_sum_distribution(exact_below - 1, exact_below - 1).at_most(u),
              RankDistribution::normal(mean, deviation).at_most(u), 2e-4);
  EXPECT_FALSE(rank_sum_distribution(exact_below, 1).is_exact());
  const double v_mean = size * (size + 1) / 4,
               v_deviation = std::sqrt(size * (size + 1) * (2 * size + 1) / 24);
  const double v = std::floor(v_mean - 2 * v_deviation);
  EXPECT_NEAR(signed_rank_distribution(exact_below - 1).at_most(v),
              RankDistribution::normal(v_mean, v_deviation).at_most(v), 5e-4);
  EXPECT_FALSE(signed_rank_distribution(exact_below).is_exact());
}

TEST(RankDistributions, GiveTheCriticalValuesOfThePrintedTables) {
  // The largest U that is significant at 5 %, two-sided, is one less than the rank. H. B. Mann and D. R.
  // Whitney's tables as reprinted in S. Siegel, Nonparametric Statistics, McGraw-Hill 1956, Table K:
  // (4, 4): 0, (5, 5): 2, (8, 8): 13, (10, 10): 23, (20, 20): 127; none for (3, 3).
  EXPECT_EQ(rank_sum_distribution(4, 4).interval_rank(), 1U);
  EXPECT_EQ(rank_sum_distribution(5, 5).interval_rank(), 3U);
  EXPECT_EQ(rank_sum_distribution(8, 8).interval_rank(), 14U);
  EXPECT_EQ(rank_sum_distribution(10, 10).interval_rank(), 24U);
  EXPECT_EQ(rank_sum_distribution(20, 20).interval_rank(), 128U);
  EXPECT_EQ(rank_sum_distribution(3, 3).interval_rank(), 0U);
  // The same for Wilcoxon's T, Table G: 6: 0, 7: 2, 8: 4, 10: 8, 20: 52; none for 5.
  EXPECT_EQ(signed_rank_distribution(6).interval_rank(), 1U);
  EXPECT_EQ(signed_rank_distribution(7).interval_rank(), 3U);
  EXPECT_EQ(signed_rank_distribution(8).interval_rank(), 4U);  // T = 4 has 2.7 % a side, the table rounds
  EXPECT_EQ(signed_rank_distribution(10).interval_rank(), 9U);
  EXPECT_EQ(signed_rank_distribution(20).interval_rank(), 53U);
  EXPECT_EQ(signed_rank_distribution(5).interval_rank(), 0U);
}

TEST(RankDistributions, LeaveAsMuchOutsideTheIntervalWhenTheyAreNormal) {
  for (const std::size_t size : {50UL, 51UL, 300UL, 100000UL})
    for (const RankDistribution& distribution :
         {rank_sum_distribution(size, size), signed_rank_distribution(size)}) {
      const auto rank = static_cast<double>(distribution.interval_rank());
      EXPECT_LE(distribution.at_most(rank - 1), 0.025) << size;
      EXPECT_GT(distribution.at_most(rank), 0.025) << size;
    }
}

TEST(RankDistributions, OfValuesThatAreAllEqualFindNothing) {
  const RankDistribution distribution = RankDistribution::normal(4.5, 0);
  EXPECT_EQ(distribution.at_most(4.5), 1);
  EXPECT_EQ(distribution.at_least(4.5), 1);
}

}  // namespace
}  // namespace mssim
