#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

#include "statistics/rank_tests.h"

namespace mssim {
namespace {

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

TEST(RankSum, ShiftsLargeSamplesByThePublishedExample) {
  // NAG Library Manual, example program of g07ebc: 0.9505, from 0.5650 to 1.3050.
  const std::vector<double> first{
      -0.582, 0.157,  -0.523, -0.769, 2.338,  1.664,  -0.981, 1.549,  1.131,  -0.460, -0.484, 1.932,  0.306,
      -0.602, -0.979, 0.132,  0.256,  -0.094, 1.065,  -1.084, -0.969, -0.524, 0.239,  1.512,  -0.782, -0.252,
      -1.163, 1.376,  1.674,  0.831,  1.478,  -1.486, -0.808, -0.429, -2.002, 0.482,  -1.584, -0.105, 0.429,
      0.568,  0.944,  2.558,  -1.801, 0.242,  0.763,  -0.461, -1.497, -1.353, 0.301,  1.941};
  const std::vector<double> second{
      1.995, 0.007,  0.997,  1.089, 2.004, 0.171,  0.294,  2.448,  0.214,  0.773,  2.960, 0.025,  0.638,
      0.937, -0.568, -0.711, 0.931, 2.601, 1.121,  -0.251, -0.050, 1.341,  2.282,  0.745, 1.633,  0.944,
      2.370, 0.293,  0.895,  0.938, 0.199, 0.812,  1.253,  0.590,  1.522,  -0.685, 1.259, 0.571,  1.579,
      0.568, 0.381,  0.829,  0.277, 0.656, 2.497,  1.779,  1.922,  -0.174, 2.132,  2.793, 0.102,  1.569,
      1.267, 0.490,  0.077,  1.366, 0.056, 0.605,  0.628,  1.650,  0.104,  2.194,  2.869, -0.171, -0.598,
      2.134, 0.917,  0.630,  0.209, 1.328, 0.368,  0.756,  2.645,  1.161,  0.347,  0.920, 1.256,  -0.052,
      1.474, 0.510,  1.386,  3.550, 1.392, -0.358, 1.938,  1.727,  -0.372, 0.911,  0.499, 0.066,  1.467,
      1.898, 1.145,  0.501,  2.230, 0.212, 0.536,  1.690,  1.086,  0.494};
  ASSERT_EQ(first.size(), 50U);
  ASSERT_EQ(second.size(), 100U);
  const ShiftEstimate shift = rank_sum_shift(second, first);
  EXPECT_NEAR(shift.shift, 0.9505, 1e-12);
  EXPECT_NEAR(shift.low, 0.5650, 1e-12);
  EXPECT_NEAR(shift.high, 1.3050, 1e-12);
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

}  // namespace
}  // namespace mssim
