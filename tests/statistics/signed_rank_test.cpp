#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

#include "statistics/rank_tests.h"

namespace mssim {
namespace {

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

TEST(SignedRank, GivesSiegelsExample) {
  // Social perceptiveness of eight pairs of twins: S. Siegel, Nonparametric Statistics, McGraw-Hill 1956,
  // in the NAG Library Manual, example program of g08agf: statistic 32, two-tailed probability 0.0547.
  const RankTest test =
      signed_rank_test(differences({82, 69, 73, 43, 58, 56, 76, 65}, {63, 42, 74, 37, 51, 43, 80, 62}));
  EXPECT_EQ(test.statistic, 32);
  EXPECT_NEAR(test.p_two_sided(), 0.0547, 5e-5);
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

TEST(SignedRank, NeedsEightRoundsForOnePercent) {
  std::vector<double> all_slower{1, 2, 3, 4, 5, 6, 7};
  EXPECT_DOUBLE_EQ(signed_rank_test(all_slower).p_two_sided(), 2. / 128);
  all_slower.push_back(8);
  EXPECT_DOUBLE_EQ(signed_rank_test(all_slower).p_two_sided(), 2. / 256);
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
