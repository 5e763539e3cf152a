#include "statistics/rank_tests.h"

#include <bit>

#include "tests/support/testing.h"

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
  // (4, 4): 0, (10, 10): 23, (20, 20): 127; none for (3, 3).
  EXPECT_EQ(rank_sum_distribution(4, 4).interval_rank(), 1U);
  EXPECT_EQ(rank_sum_distribution(10, 10).interval_rank(), 24U);
  EXPECT_EQ(rank_sum_distribution(20, 20).interval_rank(), 128U);
  EXPECT_EQ(rank_sum_distribution(3, 3).interval_rank(), 0U);
  // The same for Wilcoxon's T, Table G: 6: 0, 10: 8, 20: 52; none for 5.
  EXPECT_EQ(signed_rank_distribution(6).interval_rank(), 1U);
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

// Permeability of human chorioamnion at term and at 12 to 26 weeks: M. Hollander, D. A. Wolfe, Nonparametric
// Statistical Methods, Wiley 1973, page 69 f.; in the help of R's wilcox.test with W = 35 and a one-sided
// probability of 0.1272.
const std::vector<double> at_term{0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46};
const std::vector<double> earlier{1.15, 0.88, 0.90, 0.74, 1.21};

TEST(RankSum, GivesHollanderAndWolfesExample) {
  const RankTest test = rank_sum_test(at_term, earlier);
  EXPECT_EQ(test.statistic, 35);
  EXPECT_NEAR(test.p_greater, 0.1272, 5e-5);
  EXPECT_NEAR(test.p_two_sided(), 0.2544, 1e-4);
  EXPECT_TRUE(test.exact);
}

TEST(RankSum, OfExchangedSamplesIsItsMirrorImage) {
  const RankTest test = rank_sum_test(at_term, earlier), mirrored = rank_sum_test(earlier, at_term);
  EXPECT_EQ(mirrored.statistic, 15);
  EXPECT_DOUBLE_EQ(mirrored.p_less, test.p_greater);
  EXPECT_DOUBLE_EQ(mirrored.p_greater, test.p_less);
}

TEST(RankSum, ShiftsByHollanderAndWolfesExample) {
  // The same data, in the help of R's package coin: 0.305, from -0.15 to 0.76.
  const ShiftEstimate shift = rank_sum_shift(at_term, earlier);
  EXPECT_NEAR(shift.shift, 0.305, 1e-12);
  EXPECT_NEAR(shift.low, -0.15, 1e-12);
  EXPECT_NEAR(shift.high, 0.76, 1e-12);
  EXPECT_TRUE(shift.covers);
}

TEST(RankSum, WithTiesGivesThePublishedNormalApproximation) {
  // NAG Library Manual, example program of g08ahf: U = 86, normal statistic -2.8039, probability 0.0025.
  const std::vector<double> group_1{13, 6, 12, 7, 12, 7, 10, 7, 10, 7, 16, 7, 10, 8, 9, 8};
  const std::vector<double> group_2{17, 6,  10, 8,  15, 8,  15, 10, 15, 10, 14, 10,
                                    14, 11, 14, 11, 13, 12, 13, 12, 13, 12, 12};
  const RankTest test = rank_sum_test(group_1, group_2);
  EXPECT_EQ(test.statistic, 86);
  EXPECT_NEAR(test.p_less, 0.00252, 5e-6);  // that of -2.8039
  EXPECT_FALSE(test.exact);
}

TEST(RankSum, ShiftOfSmallSamplesIsMadeOfTheirDifferences) {
  // The differences are 1, 2, 3, 4, 5, 6: written down, the median is 3.5.
  const ShiftEstimate shift = rank_sum_shift(std::vector{10., 13.}, std::vector{7., 8., 9.});
  EXPECT_EQ(shift.shift, 3.5);
  EXPECT_EQ(shift.low, 1);
  EXPECT_EQ(shift.high, 6);
  EXPECT_FALSE(shift.covers);
  EXPECT_EQ(rank_sum_shift(std::vector{10., 10.}, std::vector{7.}).shift, 3);
  EXPECT_EQ(rank_sum_shift(std::vector{1., 2., 10.}, std::vector{0.}).shift, 2);
}

TEST(RankSum, OfEqualSamplesFindsNothing) {
  const RankTest constant = rank_sum_test(std::vector{5., 5., 5.}, std::vector{5., 5.});
  EXPECT_EQ(constant.p_two_sided(), 1);
  EXPECT_EQ(rank_sum_test(at_term, at_term).p_two_sided(), 1);
  EXPECT_EQ(rank_sum_shift(at_term, at_term).shift, 0);
}

TEST(RankSum, RefusesSamplesThatHaveNoRanks) {
  const std::vector<double> empty, good{1, 2}, bad{1, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_THROW(rank_sum_test(empty, good), std::invalid_argument);
  EXPECT_THROW(rank_sum_test(good, bad), std::invalid_argument);
  EXPECT_THROW(rank_sum_shift(good, empty), std::invalid_argument);
  EXPECT_THROW(rank_sum_shift(bad, good), std::invalid_argument);
}

std::vector<double> differences(const std::vector<double>& first, const std::vector<double>& second) {
  std::vector<double> result(first.size());
  std::transform(first.begin(), first.end(), second.begin(), result.begin(), std::minus<>());
  return result;
}

// Depression scores of nine patients before and after a tranquillizer: M. Hollander, D. A. Wolfe,
// Nonparametric Statistical Methods, Wiley 1973, page 29 f.; in the help of R's wilcox.test with V = 40
// and a one-sided probability of 0.01953.
const std::vector<double> depression = differences({1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30},
                                                   {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29});

TEST(SignedRank, GivesHollanderAndWolfesExample) {
  const RankTest test = signed_rank_test(depression);
  EXPECT_EQ(test.statistic, 40);
  EXPECT_NEAR(test.p_greater, 0.01953, 5e-6);
  EXPECT_NEAR(test.p_two_sided(), 0.03906, 5e-6);
  EXPECT_TRUE(test.exact);
}

TEST(SignedRank, ShiftsByHollanderAndWolfesExample) {
  // The same data, R's wilcox.test with conf.int: 0.46, from 0.010 to 0.786.
  const ShiftEstimate shift = signed_rank_shift(depression);
  EXPECT_NEAR(shift.shift, 0.46, 1e-12);
  EXPECT_NEAR(shift.low, 0.010, 1e-12);
  EXPECT_NEAR(shift.high, 0.786, 1e-12);
  EXPECT_TRUE(shift.covers);
}

TEST(SignedRank, ShiftsFortyValuesByThePublishedExample) {
  // NAG Library Manual, example program of g07eac: -0.1300, from -0.3300 to 0.0350.
  const std::vector<double> values{-0.23, 0.35,  -0.77, 0.35,  0.27,  -0.72, 0.08,  -0.40, -0.76, 0.45,
                                   0.73,  0.74,  0.83,  -0.87, 0.21,  0.29,  -0.91, -0.04, 0.82,  -0.38,
                                   -0.31, 0.24,  -0.47, -0.68, -0.77, -0.86, -0.59, 0.73,  0.39,  -0.44,
                                   0.63,  -0.22, -0.07, -0.43, -0.21, -0.31, 0.64,  -1.00, -0.86, -0.73};
  ASSERT_EQ(values.size(), 40U);
  const ShiftEstimate shift = signed_rank_shift(values);
  EXPECT_NEAR(shift.shift, -0.13, 1e-12);
  EXPECT_NEAR(shift.low, -0.33, 1e-12);
  EXPECT_NEAR(shift.high, 0.035, 1e-12);
}

TEST(SignedRank, WithZerosAndTiesIsApproximate) {
  // Ranks of 1, 1, 2, 3 are 1.5, 1.5, 3, 4; the variance is 4 * 5 * 9 / 24 - (8 - 2) / 48 = 7.375 and the
  // mean 5: (8.5 - 0.5 - 5) / sqrt(7.375) = 1.1047, whose upper tail is 0.1346 (a table of the normal
  // distribution).
  const RankTest test = signed_rank_test(std::vector{1., -1., 2., 0., 3.});
  EXPECT_EQ(test.statistic, 8.5);
  EXPECT_NEAR(test.p_greater, 0.1346, 1e-4);
  EXPECT_FALSE(test.exact);
}

TEST(SignedRank, OfZerosFindsNothing) {
  EXPECT_EQ(signed_rank_test(std::vector{0., 0., 0.}).p_two_sided(), 1);
  EXPECT_EQ(signed_rank_shift(std::vector{0., 0., 0.}).shift, 0);
}

TEST(SignedRank, ShiftOfFewValuesIsMadeOfTheirAverages) {
  // The averages are 1, 2, 3, 3.5, 4.5, 6.
  const ShiftEstimate shift = signed_rank_shift(std::vector{6., 1., 3.});
  EXPECT_EQ(shift.shift, 3.25);
  EXPECT_EQ(shift.low, 1);
  EXPECT_EQ(shift.high, 6);
  EXPECT_FALSE(shift.covers);
}

TEST(SignedRank, RefusesValuesThatHaveNoRanks) {
  EXPECT_THROW(signed_rank_test({}), std::invalid_argument);
  EXPECT_THROW(signed_rank_shift({}), std::invalid_argument);
  EXPECT_THROW(signed_rank_test(std::vector{std::numeric_limits<double>::infinity()}), std::invalid_argument);
}

}  // namespace
}  // namespace mssim
